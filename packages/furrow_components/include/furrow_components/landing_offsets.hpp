#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "furrow_actuation/nozzle_fit.hpp"

namespace furrow::components {

/// What a test pattern left on the ground, by axis.
using LandingOffsets = std::map<std::string, std::vector<actuation::LandingOffset>>;

/// Offsets that were measured by hand: a CSV file whose first line is
/// `axis,speed_mps,along_mm,across_mm`, then one line for each spray: the joint of its nozzle, the
/// robot's speed, and where it landed beside its aim, ahead and to the left positive. Throws
/// ConfigError with file and line.
[[nodiscard]] LandingOffsets load_landing_offsets(const std::filesystem::path& path);

}  // namespace furrow::components
