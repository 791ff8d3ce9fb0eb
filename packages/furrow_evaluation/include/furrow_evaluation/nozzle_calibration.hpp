#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_components/nozzle_file.hpp"
#include "furrow_evaluation/nozzle_pattern.hpp"

namespace furrow::evaluation {

/// One nozzle before and after its calibration.
struct NozzleCalibrationRow {
  std::string axis;
  std::size_t sprays = 0;      ///< that the fit is made of
  double before_p95_mm = 0.0;  ///< distance of the sprays from their aim
  double after_p95_mm = 0.0;   ///< NaN: not sprayed again
  actuation::NozzleCalibration before;
  actuation::NozzleCalibration after;
};

struct NozzleCalibrationResult {
  std::vector<components::CalibratedNozzle> nozzles;  ///< all of the graph, in its order
  std::vector<NozzleCalibrationRow> rows;             ///< those that were calibrated
};

/// Fits the nozzles of a graph `rounds` times, each time to a test pattern sprayed in the
/// simulator. Throws ConfigError, and std::runtime_error when a nozzle leaves nothing to fit.
[[nodiscard]] NozzleCalibrationResult calibrate_in_simulator(const launch::PreparedGraph& prepared,
                                                             const PatternOptions& pattern,
                                                             int rounds);

/// Fits the nozzles to offsets that were measured on paper; a nozzle that was not measured stays as
/// it is. Throws ConfigError, also when the file names a nozzle that the graph does not have.
[[nodiscard]] NozzleCalibrationResult calibrate_by_measurements(
    const launch::PreparedGraph& prepared, const std::filesystem::path& offsets);

/// What the report says of how the calibration was made.
struct NozzleCalibrationParameters {
  std::string graph;
  std::vector<std::string> settings;
  int sprays = 0;
  int rounds = 0;
  std::uint64_t seed = 0;
};

[[nodiscard]] std::string to_table(const std::vector<NozzleCalibrationRow>& rows);
[[nodiscard]] std::string to_json(const std::vector<NozzleCalibrationRow>& rows,
                                  const NozzleCalibrationParameters& parameters,
                                  std::string_view version);

}  // namespace furrow::evaluation
