#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "furrow_actuation/nozzle.hpp"

namespace furrow::components {

/// The calibration of the nozzle of one axis.
struct CalibratedNozzle {
  std::string axis;
  actuation::NozzleCalibration calibration;

  void visit(ParameterVisitor& v);
};

/// Reads a calibration file: a list `nozzles` with one map per axis. Throws ConfigError with file,
/// line and key, also when an axis has two entries or an entry has no axis.
[[nodiscard]] std::vector<CalibratedNozzle> load_nozzle_file(const std::filesystem::path& path);

/// The entry of one axis. Throws ConfigError when the file has none.
[[nodiscard]] actuation::NozzleCalibration load_nozzle(const std::filesystem::path& path,
                                                       const std::string& axis);

/// The text of a calibration file, which load_nozzle_file() reads without loss. `comment` becomes
/// its first line.
[[nodiscard]] std::string nozzle_file_text(const std::vector<CalibratedNozzle>& nozzles,
                                           const std::string& comment);

}  // namespace furrow::components
