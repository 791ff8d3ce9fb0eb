#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "furrow_launch/transport_options.hpp"

namespace furrow::benchmarks {

struct GraphBenchmark {
  std::vector<std::size_t> bytes = {100, 1'000'000, 6'000'000};
  double scale = 1.0;      ///< of the number of messages
  double reader_us = 0.0;  ///< for which Furrow's reader computes with each message
  double length_m = 4.0;   ///< of the row that is driven end to end; 0: none
  std::uint64_t seed = 1;
  launch::TransportOptions transport;
};

struct GraphBenchmarkRow {
  std::string path;
  std::size_t bytes = 0;
  double p50_us = 0.0;
  double p99_us = 0.0;
  std::size_t messages = 0;
  std::size_t lost = 0;
};

struct GraphBenchmarkResult {
  std::vector<GraphBenchmarkRow> rows;
  bool payload_copied = false;  ///< between components of one process
};

/// Measures these paths, each from publication to the reader's callback:
/// - delivery inside a process, alone and while a recorder of another process reads along;
/// - Fast DDS's own delivery inside a process;
/// - between two processes, Furrow and plain Fast DDS in turns;
/// - of a frame, from the camera's stamp to the plan at the tool.
/// Throws std::runtime_error.
[[nodiscard]] GraphBenchmarkResult run_graph_benchmark(const GraphBenchmark& benchmark);

/// The other process: reads until it gets SIGTERM, then writes its measurements into `file`.
void run_graph_benchmark_peer(const GraphBenchmark& benchmark, const std::string& file);

}  // namespace furrow::benchmarks
