#include "spray_log.hpp"

#include <utility>

#include "furrow_graph/stamp.hpp"

namespace furrow::components {

void SprayLog::open(furrow_msgs::msg::AxisEvent event, Time opened) {
  event.opened(graph::to_msg(opened));
  sprays_.push_back({std::move(event), opened + delay_, std::nullopt});
}

furrow_msgs::msg::AxisEvent* SprayLog::opened() {
  const bool open = !sprays_.empty() && !sprays_.back().last_drop;
  return open ? &sprays_.back().event : nullptr;
}

void SprayLog::close(Time closed) {
  if (opened() == nullptr) return;
  Spray& spray = sprays_.back();
  spray.last_drop = closed + delay_;
  spray.event.closed(graph::to_msg(closed));
  spray.event.header().stamp(graph::to_msg(*spray.last_drop));
}

std::optional<furrow_msgs::msg::AxisEvent> SprayLog::sample(Time now,
                                                            const actuation::AxisReading& reading) {
  const auto position_at = [&](Time time) {
    return reading.position_m + reading.velocity_mps * (time - now).to_seconds();
  };
  for (Spray& spray : sprays_) {
    if (spray.first_measured || now < spray.first_drop) continue;
    spray.first_measured = true;
    spray.event.position_opened_m(position_at(spray.first_drop));
    spray.event.velocity_opened_mps(reading.velocity_mps);
  }
  if (sprays_.empty() || !sprays_.front().last_drop || now < *sprays_.front().last_drop) {
    return std::nullopt;
  }
  furrow_msgs::msg::AxisEvent event = std::move(sprays_.front().event);
  event.position_closed_m(position_at(*sprays_.front().last_drop));
  event.velocity_closed_mps(reading.velocity_mps);
  sprays_.erase(sprays_.begin());
  return event;
}

}  // namespace furrow::components
