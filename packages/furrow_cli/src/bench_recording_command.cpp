#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "command.hpp"
#include "console.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"
#include "recording_benchmark.hpp"
#include "verb.hpp"

namespace furrow::cli {
namespace {

struct BenchRecordingOptions {
  RecordingBenchmark benchmark;
  std::string folder = ".";
  std::string json;
};

void bench(BenchRecordingOptions options) {
  if (!std::filesystem::is_directory(options.folder)) {
    throw ConfigError("--folder: " + options.folder + " is not a folder");
  }
  options.benchmark.folder = options.folder;
  const RecordingBenchmarkResult result = run_recording_benchmark(options.benchmark);
  nlohmann::ordered_json json = {{"rows", nlohmann::ordered_json::array()}};
  std::vector<std::vector<std::string>> table = {{"recorder MB/s", "dd MB/s", "ratio", "lost"}};
  for (const recording::WriteBenchmarkRun& run : result.writes) {
    const double ratio = run.recorder_mbps / run.dd_mbps;
    table.push_back({number(run.recorder_mbps, 0), number(run.dd_mbps, 0), number(ratio, 3),
                     std::to_string(run.dropped)});
    json["rows"].push_back({{"measure", "write"},
                            {"recorder_mbps", run.recorder_mbps},
                            {"dd_mbps", run.dd_mbps},
                            {"ratio", ratio},
                            {"lost", run.dropped}});
  }
  const RecordedGraphTiming& graph = result.graph;
  json["rows"].push_back({{"measure", "graph"},
                          {"alone_p50_us", graph.alone_p50_us},
                          {"alone_p99_us", graph.alone_p99_us},
                          {"recorded_p50_us", graph.recorded_p50_us},
                          {"recorded_p99_us", graph.recorded_p99_us},
                          {"messages", graph.messages},
                          {"lost", graph.lost}});
  const PlaybackTiming& playback = result.playback;
  json["rows"].push_back({{"measure", "playback"},
                          {"timing_error_p50_ms", playback.p50_ms},
                          {"timing_error_p99_ms", playback.p99_ms},
                          {"handed_over_p99_ms", playback.handed_over_p99_ms},
                          {"messages", playback.messages},
                          {"lost", playback.lost}});
  json["parameters"] = {{"megabytes", options.benchmark.write.megabytes},
                        {"runs", options.benchmark.write.runs},
                        {"messages", options.benchmark.messages},
                        {"play_s", options.benchmark.play_s}};
  json["version"] = FURROW_VERSION;
  std::cout << text_table(table) << "\nhand-off of an image in a graph, us: alone p50 "
            << number(graph.alone_p50_us, 1) << ", p99 " << number(graph.alone_p99_us, 1)
            << "; recorded p50 " << number(graph.recorded_p50_us, 1) << ", p99 "
            << number(graph.recorded_p99_us, 1) << "; " << graph.lost << " of " << graph.messages
            << " lost\nplayback at rate 1, timing error in ms: p50 " << number(playback.p50_ms, 3)
            << ", p99 " << number(playback.p99_ms, 3) << " as sent, "
            << number(playback.handed_over_p99_ms, 3) << " as handed over; " << playback.lost
            << " of " << playback.messages << " lost\n";
  if (options.json.empty()) return;
  if (const Status written = write_file_atomically(options.json, json.dump(2) + "\n"); !written) {
    throw std::runtime_error(written.error().message);
  }
  std::cout << options.json << '\n';
}

}  // namespace

void add_bench_recording_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command = group(app, "bench", "Speeds, with the alternative measured beside.");
  auto options = std::make_shared<BenchRecordingOptions>();
  CLI::App* recording = command->add_subcommand(
      "recording", "Writing beside dd on the same disk, a recorded graph, and playback's timing.");
  recording->add_option("--folder", options->folder, "on the disk to measure")
      ->capture_default_str();
  recording->add_option("--megabytes", options->benchmark.write.megabytes, "written in each run")
      ->check(CLI::Range(10, 1'000'000))
      ->capture_default_str();
  recording->add_option("--runs", options->benchmark.write.runs, "of recorder and dd, in turns")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  recording->add_option("--messages", options->benchmark.messages, "of the recorded graph")
      ->check(CLI::Range(30, 100'000))
      ->capture_default_str();
  recording->add_option("--play", options->benchmark.play_s, "seconds of playback")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  recording->add_option("--json", options->json, "file of the results");
  add_wire_options(*recording, options->benchmark.wire);
  recording->callback([options] { bench(*options); });
}

}  // namespace furrow::cli
