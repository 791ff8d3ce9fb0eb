#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "furrow_launch/transport_options.hpp"
#include "furrow_recording/write_benchmark.hpp"

namespace furrow::benchmarks {

struct RecordingBenchmark {
  std::filesystem::path folder;  ///< on the disk that is measured
  recording::WriteBenchmarkOptions write;
  double play_s = 10.0;
  int messages = 300;  ///< of the graph that is recorded
  launch::TransportOptions transport;
};

struct PlaybackTiming {
  std::uint64_t messages = 0;
  std::uint64_t lost = 0;
  double p50_ms = 0.0;  ///< |sent - recorded - its median|, at the reader
  double p99_ms = 0.0;
  double published_p99_ms = 0.0;  ///< later than due, at the player
};

/// A graph that hands images over, alone and with a recorder component in it.
struct RecordedGraphTiming {
  double alone_p50_us = 0.0;
  double alone_p99_us = 0.0;
  double recorded_p50_us = 0.0;
  double recorded_p99_us = 0.0;
  std::uint64_t messages = 0;
  std::uint64_t lost = 0;  ///< not in the file
};

struct RecordingBenchmarkResult {
  std::vector<recording::WriteBenchmarkRun> writes;
  RecordedGraphTiming graph;
  PlaybackTiming playback;
};

/// Throws std::runtime_error when the disk refuses.
[[nodiscard]] RecordingBenchmarkResult run_recording_benchmark(const RecordingBenchmark& benchmark);

}  // namespace furrow::benchmarks
