#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "furrow_actuation/nozzle.hpp"

namespace furrow::components {

/// What was measured of the nozzle of one axis.
struct CalibratedNozzle {
  std::string axis;
  actuation::NozzleCalibration calibration;

  void visit(ParameterVisitor& v);
};

/// A calibration file: a list `nozzles` with one map per axis. Throws ConfigError with file, line
/// and key; also when an axis is named twice or not at all.
[[nodiscard]] std::vector<CalibratedNozzle> load_nozzle_file(const std::filesystem::path& path);

/// The entry of one axis. Throws ConfigError when the file has none.
[[nodiscard]] actuation::NozzleCalibration load_nozzle(const std::filesystem::path& path,
                                                       const std::string& axis);

/// The file's text; load_nozzle_file() reads the same numbers from it. `comment` stands above it.
[[nodiscard]] std::string nozzle_file_text(const std::vector<CalibratedNozzle>& nozzles,
                                           const std::string& comment);

}  // namespace furrow::components
