#include "speed_requests.hpp"

#include <algorithm>
#include <iterator>

#include "furrow_graph/stamp.hpp"

namespace furrow::components {

SpeedRequests::SpeedRequests(graph::Context& context, bool govern,
                             const planning::SpeedGovernorParameters& parameters,
                             double row_speed_mps, std::span<const planning::AxisSpec> axes)
    : context_(context), out_(context.output<msgs::topics::SpeedRequest>()) {
  if (!govern || axes.empty()) return;
  const auto [rear, front] = std::ranges::minmax(axes, {}, &planning::AxisSpec::offset_x_m);
  governor_ = std::make_unique<planning::SpeedGovernor>(parameters, row_speed_mps, front.offset_x_m,
                                                        rear.offset_x_m);
}

void SpeedRequests::consider(const planning::RobotState& robot, planning::ObservationView& view) {
  if (!governor_) return;
  Status status = governor_->consider(
      {robot.x_m, robot.speed_mps, view.committed_until_x_m(), std::ssize(view.plan().decisions)},
      [&view](const planning::SpeedProfile& speeds) { return view.left_at(speeds); });
  if (status.ok()) status = view.set_speeds(governor_->expected());
  if (!status.ok()) {
    context_.warn("speed_not_considered", status.error().message + "; the requested speed is kept");
  }
}

void SpeedRequests::publish(const BaseOdometry& base) {
  if (!governor_) return;
  geometry_msgs::msg::TwistStamped message;
  message.header(header(base.stamp, kBaseFrame));
  message.twist().linear().x(governor_->request_mps(base.X_FB.x_m));
  out_.publish(std::move(message));
}

}  // namespace furrow::components
