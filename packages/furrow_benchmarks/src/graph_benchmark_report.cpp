#include "furrow_benchmarks/graph_benchmark_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "furrow_core/text.hpp"

namespace furrow::benchmarks {
namespace {

using Ratios = std::vector<std::pair<std::string, double>>;

constexpr std::size_t kSmall = 100;
constexpr std::size_t kMiddle = 1'000'000;
constexpr std::size_t kLarge = 6'000'000;

GraphBenchmarkRow row_at(const GraphBenchmarkResult& result, const std::string& path,
                         std::size_t bytes) {
  const auto it = std::ranges::find_if(result.rows, [&](const GraphBenchmarkRow& row) {
    return row.path == path && row.bytes == bytes;
  });
  return it == result.rows.end() ? GraphBenchmarkRow() : *it;
}

double ratio(double a, double b) {
  return b > 0.0 ? a / b : 0.0;
}

Ratios ratios_of(const GraphBenchmarkResult& result) {
  const auto p50 = [&](const char* path, std::size_t bytes, const char* other,
                       std::size_t other_bytes) {
    return ratio(row_at(result, path, bytes).p50_us, row_at(result, other, other_bytes).p50_us);
  };
  const auto p99 = [&](const char* path, const char* other, std::size_t bytes) {
    return ratio(row_at(result, path, bytes).p99_us, row_at(result, other, bytes).p99_us);
  };
  return {
      {"in_process_6mb_over_100b_p50", p50("in_process", kLarge, "in_process", kSmall)},
      {"fastdds_over_in_process_6mb_p50", p50("fastdds_in_process", kLarge, "in_process", kLarge)},
      {"fastdds_bytes_over_in_process_6mb_p50",
       p50("fastdds_in_process_bytes", kLarge, "in_process", kLarge)},
      {"observed_over_alone_100b_p99", p99("in_process_observed", "in_process", kSmall)},
      {"observed_over_alone_1mb_p99", p99("in_process_observed", "in_process", kMiddle)},
      {"observed_over_alone_6mb_p99", p99("in_process_observed", "in_process", kLarge)},
      {"two_processes_over_fastdds_1mb_p50",
       p50("two_processes", kMiddle, "fastdds_two_processes", kMiddle)},
      {"two_processes_over_fastdds_6mb_p50",
       p50("two_processes", kLarge, "fastdds_two_processes", kLarge)},
      {"two_processes_over_fastdds_1mb_p99",
       p99("two_processes", "fastdds_two_processes", kMiddle)},
      {"two_processes_over_fastdds_6mb_p99", p99("two_processes", "fastdds_two_processes", kLarge)},
      {"distributed_over_composed_p50",
       p50("end_to_end_distributed", 0, "end_to_end_composed", 0)}};
}

}  // namespace

std::string to_text(const GraphBenchmarkResult& result) {
  std::vector<std::vector<std::string>> table = {
      {"path", "bytes", "p50 us", "p99 us", "messages", "lost"}};
  for (const GraphBenchmarkRow& row : result.rows) {
    table.push_back({row.path, std::to_string(row.bytes), fixed(row.p50_us, 1),
                     fixed(row.p99_us, 1), std::to_string(row.messages), std::to_string(row.lost)});
  }
  std::string text = text_table(table) + "\n";
  for (const auto& [name, value] : ratios_of(result)) text += name + ": " + fixed(value, 3) + "\n";
  return text + "payload copied in the process: " + (result.payload_copied ? "yes" : "no") + "\n";
}

std::string to_json(const GraphBenchmark& benchmark, const GraphBenchmarkResult& result,
                    std::string_view version) {
  nlohmann::ordered_json json = {{"rows", nlohmann::ordered_json::array()}};
  for (const GraphBenchmarkRow& row : result.rows) {
    json["rows"].push_back({{"path", row.path},
                            {"bytes", row.bytes},
                            {"p50_us", row.p50_us},
                            {"p99_us", row.p99_us},
                            {"messages", row.messages},
                            {"lost", row.lost}});
  }
  for (const auto& [name, value] : ratios_of(result)) json["ratios"][name] = value;
  json["payload_copied_in_process"] = result.payload_copied;
  json["seed"] = benchmark.seed;
  json["parameters"] = {{"scale", benchmark.scale},
                        {"reader_us", benchmark.reader_us},
                        {"length_m", benchmark.length_m},
                        {"dds", benchmark.transport.settings}};
  json["version"] = version;
  return json.dump(2) + "\n";
}

}  // namespace furrow::benchmarks
