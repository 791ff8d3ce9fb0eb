#include <filesystem>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "furrow_benchmarks/recording_benchmark.hpp"
#include "furrow_benchmarks/recording_benchmark_report.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/version.hpp"
#include "output_options.hpp"
#include "transport_options.hpp"

namespace furrow::cli {
namespace {

struct BenchRecordingOptions {
  benchmarks::RecordingBenchmark benchmark;
  std::string folder = ".";
  ResultOptions results;
};

int bench_recording(const BenchRecordingOptions& options) {
  if (!std::filesystem::is_directory(options.folder)) {
    throw ConfigError("--folder: " + options.folder + " is not a folder");
  }
  ResultFiles files(options.results);
  benchmarks::RecordingBenchmark benchmark = options.benchmark;
  benchmark.folder = options.folder;
  const auto result = benchmarks::run_recording_benchmark(benchmark);
  std::cout << benchmarks::to_text(result);
  files.write_json(benchmarks::to_json(benchmark, result, version()));
  return 0;
}

}  // namespace

void add_bench_recording_command(Command root) {
  auto options = std::make_shared<BenchRecordingOptions>();
  benchmarks::RecordingBenchmark& benchmark = options->benchmark;
  Command command = bench_group(root).subcommand(
      "recording", "Writing beside dd on the same disk, a recorded graph, playback's timing.");
  command.option("--folder", options->folder, "a folder on the disk to measure");
  command.option("--megabytes", benchmark.write.megabytes, "megabytes to write in each run")
      .range(10, 1'000'000);
  command.option("--runs", benchmark.write.runs, "runs of recorder and dd, in turns").range(1, 100);
  command.option("--messages", benchmark.messages, "messages of the recorded graph")
      .range(30, 100'000);
  command.option("--play", benchmark.play_s, "duration of the playback, s").range(1.0, 3600.0);
  add_transport_options(command, benchmark.transport);
  add_result_options(command, options->results, false);
  command.on_run([options] { return bench_recording(*options); });
}

}  // namespace furrow::cli
