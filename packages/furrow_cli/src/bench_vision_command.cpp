#include <iostream>
#include <memory>

#include "commands.hpp"
#include "furrow_benchmarks/vision_benchmark.hpp"
#include "furrow_core/version.hpp"
#include "output_options.hpp"
#include "vision_options.hpp"

namespace furrow::cli {
namespace {

struct BenchVisionOptions {
  VisionOptions vision;
  benchmarks::VisionBenchmark benchmark;
  ResultOptions results;
};

int bench_vision(const BenchVisionOptions& options) {
  ResultFiles files(options.results);
  benchmarks::VisionBenchmark benchmark = options.benchmark;
  benchmark.detectors = options.vision.choices;
  const auto rows = benchmarks::run_vision_benchmark(benchmark);
  std::cout << benchmarks::to_table(rows);
  files.write_json(benchmarks::to_json(benchmark, rows, version()));
  return 0;
}

}  // namespace

void add_bench_vision_command(Command root) {
  auto options = std::make_shared<BenchVisionOptions>();
  benchmarks::VisionBenchmark& benchmark = options->benchmark;
  Command command = bench_group(root).subcommand(
      "vision", "Time and memory of each detector on a rendered image.");
  add_vision_options(command, options->vision);
  command.option("--frames", benchmark.frames, "frames to measure for each detector")
      .range(1, 100'000);
  command.option("--threads", benchmark.threads, "threads of OpenCV").range(1, 256);
  command.option("--seed", benchmark.seed, "seed of the images");
  add_result_options(command, options->results, false);
  command.on_run([options] { return bench_vision(*options); });
}

}  // namespace furrow::cli
