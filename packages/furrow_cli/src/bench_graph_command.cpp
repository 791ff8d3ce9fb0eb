#include <iostream>
#include <memory>

#include "commands.hpp"
#include "furrow_benchmarks/graph_benchmark.hpp"
#include "furrow_benchmarks/graph_benchmark_report.hpp"
#include "furrow_core/version.hpp"
#include "output_options.hpp"
#include "transport_options.hpp"

namespace furrow::cli {
namespace {

struct BenchGraphOptions {
  benchmarks::GraphBenchmark benchmark;
  ResultOptions results;
};

int bench_graph(const BenchGraphOptions& options) {
  ResultFiles files(options.results);
  const auto result = benchmarks::run_graph_benchmark(options.benchmark);
  std::cout << benchmarks::to_text(result);
  files.write_json(benchmarks::to_json(options.benchmark, result, version()));
  return 0;
}

/// The other process of the benchmark, which starts it itself.
void add_peer_command(Command group) {
  auto options = std::make_shared<BenchGraphOptions>();
  Command command = group.subcommand("graph-peer", "The other process of `bench graph`.");
  command.hide();
  command.option("--json", options->results.json, "file for the measurements").required();
  command.option("--reader-us", options->benchmark.reader_us, "as in `bench graph`");
  add_transport_options(command, options->benchmark.transport);
  command.on_run([options] {
    benchmarks::run_graph_benchmark_peer(options->benchmark, options->results.json);
    return 0;
  });
}

}  // namespace

void add_bench_graph_command(Command root) {
  auto options = std::make_shared<BenchGraphOptions>();
  benchmarks::GraphBenchmark& benchmark = options->benchmark;
  Command command = bench_group(root).subcommand(
      "graph", "Delivery within a process and between two, beside plain Fast DDS.");
  command.option("--scale", benchmark.scale, "factor on the number of messages").range(0.01, 100.0);
  command
      .option("--length", benchmark.length_m,
              "distance to drive in real time for the times from frame to plan, m; 0: skip")
      .range(0.0, 1000.0);
  command
      .option("--reader-us", benchmark.reader_us,
              "time that Furrow's reader computes with each message, us")
      .range(0.0, 5000.0);
  command.option("--seed", benchmark.seed, "seed of the driven row");
  add_transport_options(command, benchmark.transport);
  add_result_options(command, options->results, false);
  command.on_run([options] { return bench_graph(*options); });
  add_peer_command(bench_group(root));
}

}  // namespace furrow::cli
