#pragma once

#include <cstdint>
#include <vector>

#include "furrow_components/landing_offsets.hpp"
#include "furrow_components/nozzle_file.hpp"
#include "furrow_launch/graph_setup.hpp"

namespace furrow::evaluation {

struct PatternOptions {
  std::vector<double> speeds_mps = {0.3, 0.6, 0.9};
  int sprays = 12;  ///< of each nozzle at each speed
  std::uint64_t seed = 1;
};

/// Drives the graph's simulated robot over a test pattern, once at each speed and in simulated
/// time. Each axis sprays single points whose places it is told, with these calibrations, at the
/// true pose. Of the graph only the robot simulator and the axis drivers are used. Throws
/// ConfigError when the graph has no simulated robot or no axis drivers.
[[nodiscard]] components::LandingOffsets run_pattern(
    const launch::PreparedGraph& prepared, const std::vector<components::CalibratedNozzle>& nozzles,
    const PatternOptions& options);

/// The calibrations that the drivers of the graph would start with, in the order of its axes.
[[nodiscard]] std::vector<components::CalibratedNozzle> nozzles_of(
    const launch::PreparedGraph& prepared);

}  // namespace furrow::evaluation
