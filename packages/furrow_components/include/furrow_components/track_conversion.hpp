#pragma once

#include <span>
#include <string>

#include "furrow_msgs/furrow_msgs.h"
#include "furrow_tracking/track.hpp"

namespace furrow::components {

/// A track as the tracker publishes it. `species` names the species that tracks vote for.
[[nodiscard]] furrow_msgs::msg::Track to_msg(const tracking::Track& track,
                                             std::span<const std::string> species);

}  // namespace furrow::components
