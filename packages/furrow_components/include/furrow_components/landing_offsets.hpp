#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "furrow_actuation/nozzle_fit.hpp"

namespace furrow::components {

/// Offsets of the sprays of a test pattern from their aims, by axis.
using LandingOffsets = std::map<std::string, std::vector<actuation::LandingOffset>>;

/// Offsets that were measured by hand, from a CSV file. Its first line is
/// `axis,speed_mps,along_mm,across_mm`. Then follows one line for each spray: the joint of its
/// nozzle, the robot's speed, and the offset of its centre from the aim, positive ahead and to the
/// left. Throws ConfigError with file and line.
[[nodiscard]] LandingOffsets load_landing_offsets(const std::filesystem::path& path);

}  // namespace furrow::components
