#pragma once

#include <optional>
#include <string>

#include "furrow_actuation/tool_loop.hpp"
#include "furrow_graph/context.hpp"
#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "spray_log.hpp"

namespace furrow::components {

/// Publishes state, events and diagnostics of one axis, and sets the health of its component.
class AxisReporter {
 public:
  /// The context must outlive it.
  AxisReporter(graph::Context& context, std::string axis, double flow_mlps, double close_delay_s);

  /// Publishes the events of a cycle. `reading`: the drive's, of this cycle.
  void report(Time now, const actuation::CycleReport& cycle, const actuation::AxisReading& reading);
  void publish_state(Time now, const actuation::AxisController& controller,
                     const actuation::AxisReading& reading);
  /// Call once a second. The texts are those of AxisRemarks.
  void publish_diagnostics(const std::string& refusal, const std::string& not_confirmed,
                           const std::string& latches);
  /// Sets the component's health where it changed.
  void update_health(Time now, const actuation::ToolSafety& safety, const std::string& refusal,
                     const std::string& not_confirmed);

 private:
  void handle(const actuation::ControllerEvent& event, Time valve_written);
  void publish(const actuation::ControllerEvent& event, msgs::AxisEventKind kind);
  void entered_safe_state(const actuation::ControllerEvent& event, Time valve_written);
  void close_spray(const actuation::ControllerEvent& event, Time valve_written);
  void set_health(graph::HealthLevel level, std::string message);

  graph::Context& context_;
  std::string axis_;
  double flow_mlps_;
  SprayLog sprays_;
  graph::Output<msgs::topics::AxisState> state_out_;
  graph::Output<msgs::topics::AxisEvent> event_out_;
  graph::Output<msgs::topics::JointStates> joint_out_;
  graph::Output<msgs::topics::Diagnostics> diagnostics_out_;
  furrow_msgs::msg::AxisState state_;  ///< last published
  Time cause_time_;
  std::optional<Time> waiting_since_;
  graph::HealthLevel level_ = graph::HealthLevel::kOk;
  std::string message_;
  std::optional<double> last_position_m_;
  double travel_m_ = 0.0;
};

}  // namespace furrow::components
