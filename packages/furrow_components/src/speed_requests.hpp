#pragma once

#include <memory>
#include <span>

#include "furrow_components/conversions.hpp"
#include "furrow_graph/component.hpp"
#include "furrow_graph/context.hpp"
#include "furrow_msgs/topics.hpp"
#include "furrow_planning/observation_view.hpp"
#include "furrow_planning/speed_governor.hpp"

namespace furrow::components {

/// Publishes the planner's speed requests to the robot. Does nothing where `govern` is false.
class SpeedRequests {
 public:
  SpeedRequests(graph::Context& context, bool govern,
                const planning::SpeedGovernorParameters& parameters, double row_speed_mps,
                std::span<const planning::AxisSpec> axes);

  /// Chooses the speed for the weeds that the view has not committed yet, and plans for it.
  void consider(const planning::RobotState& robot, planning::ObservationView& view);
  /// Publishes the request for a robot at this pose.
  void publish(const BaseOdometry& base);

 private:
  graph::Context& context_;
  graph::Output<msgs::topics::SpeedRequest> out_;
  std::unique_ptr<planning::SpeedGovernor> governor_;  ///< null: the robot keeps its speed
};

}  // namespace furrow::components
