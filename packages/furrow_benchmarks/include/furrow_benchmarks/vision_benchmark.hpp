#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_evaluation/detector_choices.hpp"

namespace furrow::benchmarks {

/// Time and memory of detectors on rendered images.
struct VisionBenchmark {
  evaluation::DetectorChoices detectors;
  std::int64_t frames = 30;  ///< measured for each detector and size
  std::uint64_t seed = 1;    ///< of the images
  int threads = 2;           ///< of OpenCV
};

struct VisionBenchmarkRow {
  std::string detector;
  int width_px = 0;
  int height_px = 0;
  double ms_p50 = 0.0;
  double ms_p99 = 0.0;
  double rss_mb = 0.0;  ///< resident memory of the process after the detector ran
};

/// Sets the number of OpenCV's threads for the whole process. Throws ConfigError, and
/// std::runtime_error when a detector fails.
[[nodiscard]] std::vector<VisionBenchmarkRow> run_vision_benchmark(
    const VisionBenchmark& benchmark);

[[nodiscard]] std::string to_table(const std::vector<VisionBenchmarkRow>& rows);
[[nodiscard]] std::string to_json(const VisionBenchmark& benchmark,
                                  const std::vector<VisionBenchmarkRow>& rows,
                                  std::string_view version);

}  // namespace furrow::benchmarks
