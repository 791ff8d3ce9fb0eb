#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "furrow_components/axis_trace.hpp"
#include "furrow_components/pose_buffer.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/context.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_simulation/spray.hpp"
#include "furrow_simulation/valve_faults.hpp"

namespace furrow::components {

/// Simulates valves and falling drops under the moving robot, and publishes where sprays land. A
/// faulty valve may release drops without a command. They are published as sprays of stop 0 without
/// tracks, one for each kSlice of time.
class SprayLanding {
 public:
  /// `odometry_gap`: how far the ground truth may be extrapolated. The context must outlive it.
  SprayLanding(graph::Context& context, geometry::ToolModel tool,
               const simulation::SprayParameters& parameters,
               const simulation::ValveFaultParameters& faults, Duration odometry_gap);

  /// Takes the spray of an event; other events are ignored.
  void take(const furrow_msgs::msg::AxisEvent& event);
  /// Takes the position of an axis, for drops that its valve releases without a command.
  void take(const furrow_msgs::msg::AxisState& state);
  /// Takes the true motion, in order of time, and publishes the sprays that are complete by then.
  /// False when the odometry is refused.
  bool move(const nav_msgs::msg::Odometry& truth);

 private:
  /// A spray whose last drop has not left the nozzle yet.
  struct Falling {
    furrow_msgs::msg::AxisEvent event;
    Time open;
    Time close;
    const geometry::AxisModel* axis;
  };

  static constexpr Duration kSlice = Duration::milliseconds(20);

  /// A valve, and what it releases without a command.
  struct Valve {
    simulation::SimulatedValve valve;
    std::optional<Time> opened_in_fault;  ///< stuck open since then
    std::optional<Time> released_until;   ///< of an uncommanded flow
    std::optional<AxisPoint> axis;        ///< newest
  };

  [[nodiscard]] simulation::ValveFault fault_of(const std::string& axis, Time time) const;
  void release_uncommanded(Time now);
  void land(const Falling& spray);
  void land_slice(const geometry::AxisModel& model, const AxisPoint& axis, Time from, Time to);
  void publish(const furrow_msgs::msg::AxisEvent& event, const simulation::SprayPatch& patch,
               double radius_m) const;
  [[nodiscard]] std::optional<simulation::NozzleState> nozzle(const geometry::AxisModel& model,
                                                              const AxisPoint& axis) const;

  graph::Context& context_;
  geometry::ToolModel tool_;
  simulation::SprayParameters parameters_;
  Duration odometry_gap_;
  graph::Output<msgs::topics::TrueSpray> out_;
  PoseBuffer truth_{Duration::seconds(2.0)};
  simulation::ValveFaultSchedule faults_;
  std::optional<Time> start_;
  std::map<std::string, Valve> valves_;
  std::vector<Falling> falling_;
};

}  // namespace furrow::components
