#include "furrow_benchmarks/recording_benchmark_report.hpp"

#include <nlohmann/json.hpp>

#include "furrow_core/text.hpp"

namespace furrow::benchmarks {

std::string to_text(const RecordingBenchmarkResult& result) {
  std::vector<std::vector<std::string>> table = {{"recorder MB/s", "dd MB/s", "ratio", "lost"}};
  for (const recording::WriteBenchmarkRun& run : result.writes) {
    table.push_back({fixed(run.recorder_mbps, 0), fixed(run.dd_mbps, 0),
                     fixed(run.recorder_mbps / run.dd_mbps, 3), std::to_string(run.dropped)});
  }
  const RecordedGraphTiming& graph = result.graph;
  const PlaybackTiming& playback = result.playback;
  return text_table(table) + "\nDelivery of an image in a graph, us: alone p50 " +
         fixed(graph.alone_p50_us, 1) + ", p99 " + fixed(graph.alone_p99_us, 1) +
         "; recorded p50 " + fixed(graph.recorded_p50_us, 1) + ", p99 " +
         fixed(graph.recorded_p99_us, 1) + "; " + std::to_string(graph.lost) + " of " +
         std::to_string(graph.messages) + " lost.\nPlayback at rate 1, timing error in ms: p50 " +
         fixed(playback.p50_ms, 3) + ", p99 " + fixed(playback.p99_ms, 3) + " as sent, " +
         fixed(playback.published_p99_ms, 3) + " as published; " + std::to_string(playback.lost) +
         " of " + std::to_string(playback.messages) + " lost.\n";
}

std::string to_json(const RecordingBenchmark& benchmark, const RecordingBenchmarkResult& result,
                    std::string_view version) {
  nlohmann::ordered_json json = {{"rows", nlohmann::ordered_json::array()}};
  for (const recording::WriteBenchmarkRun& run : result.writes) {
    json["rows"].push_back({{"measure", "write"},
                            {"recorder_mbps", run.recorder_mbps},
                            {"dd_mbps", run.dd_mbps},
                            {"ratio", run.recorder_mbps / run.dd_mbps},
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
                          {"published_p99_ms", playback.published_p99_ms},
                          {"messages", playback.messages},
                          {"lost", playback.lost}});
  json["parameters"] = {{"megabytes", benchmark.write.megabytes},
                        {"runs", benchmark.write.runs},
                        {"messages", benchmark.messages},
                        {"play_s", benchmark.play_s}};
  json["version"] = version;
  return json.dump(2) + "\n";
}

}  // namespace furrow::benchmarks
