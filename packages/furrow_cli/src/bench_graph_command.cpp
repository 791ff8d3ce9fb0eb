#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "command.hpp"
#include "console.hpp"
#include "furrow_core/file.hpp"
#include "graph_benchmark.hpp"
#include "verb.hpp"

namespace furrow::cli {
namespace {

struct BenchGraphOptions {
  GraphBenchmark benchmark;
  std::string json;
};

/// The ratios that are asked about, by what they compare.
nlohmann::ordered_json ratios_of(const GraphBenchmarkResult& result) {
  const auto at = [&result](const std::string& path, std::size_t bytes) {
    const auto it = std::ranges::find_if(result.rows, [&](const GraphBenchmarkRow& row) {
      return row.path == path && row.bytes == bytes;
    });
    return it == result.rows.end() ? GraphBenchmarkRow() : *it;
  };
  const auto ratio = [](double a, double b) { return b > 0.0 ? a / b : 0.0; };
  constexpr std::size_t kSmall = 100;
  constexpr std::size_t kMiddle = 1'000'000;
  constexpr std::size_t kLarge = 6'000'000;
  const auto observed = [&](std::size_t bytes) {
    return ratio(at("in_process_observed", bytes).p99_us, at("in_process", bytes).p99_us);
  };
  const auto wire = [&](std::size_t bytes) {
    return ratio(at("two_processes", bytes).p50_us, at("fastdds_two_processes", bytes).p50_us);
  };
  return {{"in_process_6mb_over_100b_p50",
           ratio(at("in_process", kLarge).p50_us, at("in_process", kSmall).p50_us)},
          {"fastdds_over_in_process_6mb_p50",
           ratio(at("fastdds_in_process", kLarge).p50_us, at("in_process", kLarge).p50_us)},
          {"fastdds_bytes_over_in_process_6mb_p50",
           ratio(at("fastdds_in_process_bytes", kLarge).p50_us, at("in_process", kLarge).p50_us)},
          {"observed_over_alone_100b_p99", observed(kSmall)},
          {"observed_over_alone_1mb_p99", observed(kMiddle)},
          {"observed_over_alone_6mb_p99", observed(kLarge)},
          {"two_processes_over_fastdds_1mb_p50", wire(kMiddle)},
          {"two_processes_over_fastdds_6mb_p50", wire(kLarge)},
          {"two_processes_over_fastdds_1mb_p99",
           ratio(at("two_processes", kMiddle).p99_us, at("fastdds_two_processes", kMiddle).p99_us)},
          {"two_processes_over_fastdds_6mb_p99",
           ratio(at("two_processes", kLarge).p99_us, at("fastdds_two_processes", kLarge).p99_us)},
          {"distributed_over_composed_p50",
           ratio(at("end_to_end_distributed", 0).p50_us, at("end_to_end_composed", 0).p50_us)}};
}

void bench(const BenchGraphOptions& options) {
  const GraphBenchmarkResult result = run_graph_benchmark(options.benchmark);
  std::vector<std::vector<std::string>> table = {
      {"path", "bytes", "p50 us", "p99 us", "messages", "lost"}};
  nlohmann::ordered_json json = {{"rows", nlohmann::ordered_json::array()}};
  for (const GraphBenchmarkRow& row : result.rows) {
    table.push_back({row.path, std::to_string(row.bytes), number(row.p50_us, 1),
                     number(row.p99_us, 1), std::to_string(row.messages),
                     std::to_string(row.lost)});
    json["rows"].push_back({{"path", row.path},
                            {"bytes", row.bytes},
                            {"p50_us", row.p50_us},
                            {"p99_us", row.p99_us},
                            {"messages", row.messages},
                            {"lost", row.lost}});
  }
  json["ratios"] = ratios_of(result);
  json["payload_copied_in_process"] = result.payload_copied;
  json["seed"] = options.benchmark.seed;
  json["parameters"] = {{"scale", options.benchmark.scale},
                        {"reader_us", options.benchmark.reader_us},
                        {"length_m", options.benchmark.length_m},
                        {"wire", options.benchmark.wire.settings}};
  json["version"] = FURROW_VERSION;
  std::cout << text_table(table) << '\n';
  for (const auto& [name, value] : json["ratios"].items()) {
    std::cout << name << ": " << number(value.get<double>(), 3) << '\n';
  }
  std::cout << "payload copied in the process: " << (result.payload_copied ? "yes" : "no") << '\n';
  if (options.json.empty()) return;
  if (const Status written = write_file_atomically(options.json, json.dump(2) + "\n"); !written) {
    throw std::runtime_error(written.error().message);
  }
  std::cout << options.json << '\n';
}

}  // namespace

void add_bench_graph_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command = group(app, "bench", "Speeds, with the alternative measured beside.");
  auto options = std::make_shared<BenchGraphOptions>();
  CLI::App* graph = command->add_subcommand(
      "graph", "Delivery within a process and between two, beside plain Fast DDS.");
  graph->add_option("--scale", options->benchmark.scale, "of the number of messages")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  graph
      ->add_option("--length", options->benchmark.length_m,
                   "metres driven in real time from frame to plan; 0: not")
      ->check(CLI::Range(0.0, 1000.0))
      ->capture_default_str();
  graph
      ->add_option("--reader-us", options->benchmark.reader_us,
                   "for which Furrow's reader computes with each message; a longer one is called "
                   "by a thread that is woken for it")
      ->check(CLI::Range(0.0, 5000.0))
      ->capture_default_str();
  graph->add_option("--seed", options->benchmark.seed, "of the driven row")->capture_default_str();
  graph->add_option("--json", options->json, "file of the results");
  add_wire_options(*graph, options->benchmark.wire);
  graph->callback([options] { bench(*options); });
  CLI::App* peer = command->add_subcommand("graph-peer", "The other process of `bench graph`.");
  peer->group("");
  peer->add_option("--json", options->json, "file of the results")->required();
  peer->add_option("--reader-us", options->benchmark.reader_us, "as in `bench graph`");
  add_wire_options(*peer, options->benchmark.wire);
  peer->callback([options] { run_graph_benchmark_peer(options->benchmark, options->json); });
}

}  // namespace furrow::cli
