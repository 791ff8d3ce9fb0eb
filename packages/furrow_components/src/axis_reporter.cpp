#include "axis_reporter.hpp"

#include <cmath>
#include <utility>

#include "axis_conversion.hpp"
#include "axis_diagnostics.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_core/text.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/diagnostic_msgs.h"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::components {

namespace topics = msgs::topics;
using actuation::ControllerEvent;
using actuation::ControllerEventKind;
using actuation::ControllerMode;
using msgs::AxisEventKind;

AxisReporter::AxisReporter(graph::Context& context, std::string axis, double flow_mlps,
                           double close_delay_s)
    : context_(context),
      axis_(std::move(axis)),
      flow_mlps_(flow_mlps),
      sprays_(Duration::seconds(close_delay_s)),
      state_out_(context.output<topics::AxisState>()),
      event_out_(context.output<topics::AxisEvent>()),
      joint_out_(context.output<topics::JointStates>()),
      diagnostics_out_(context.output<topics::Diagnostics>()) {}

void AxisReporter::report(Time now, const actuation::CycleReport& cycle,
                          const actuation::AxisReading& reading) {
  if (!cycle.read_ok) context_.warn("read_errors", "the drive could not be read");
  if (!cycle.valve_ok) context_.warn("valve_errors", "the valve could not be switched");
  if (!cycle.write_ok) context_.warn("write_errors", "the drive took no command");
  for (std::size_t i = 0; i < cycle.output.events.size(); ++i) {
    handle(cycle.output.events[i], cycle.valve_written);
  }
  if (auto spray = sprays_.sample(now, reading)) event_out_.publish(std::move(*spray));
}

void AxisReporter::handle(const ControllerEvent& event, Time valve_written) {
  switch (event.kind) {
    case ControllerEventKind::kSprayOpened: {
      const AxisEventKind kind = event.dry_run ? AxisEventKind::kDryRun : AxisEventKind::kSprayed;
      sprays_.open(to_msg(event, axis_, kind), valve_written);
      break;
    }
    case ControllerEventKind::kSprayClosed:
      close_spray(event, valve_written);
      break;
    case ControllerEventKind::kStopSkipped:
      context_.count("skipped_" + std::string(actuation::to_string(event.reason)));
      publish(event, skip_event(event.reason));
      break;
    case ControllerEventKind::kSafeState:
      entered_safe_state(event, valve_written);
      break;
    case ControllerEventKind::kReset:
      context_.log(log::Level::kInfo, "reset: " + std::string(to_string(event.cause)) + " ended");
      publish(event, AxisEventKind::kReset);
      break;
    case ControllerEventKind::kResetRefused:
      context_.warn("resets_refused", "reset refused: " + std::string(to_string(event.cause)) +
                                          " persists; the tool stays in its safe state");
      publish(event, AxisEventKind::kResetRefused);
      break;
  }
}

void AxisReporter::publish(const ControllerEvent& event, AxisEventKind kind) {
  event_out_.publish(to_msg(event, axis_, kind));
}

void AxisReporter::entered_safe_state(const ControllerEvent& event, Time valve_written) {
  context_.count("safe_states");
  context_.log(log::Level::kError, "safe state entered: " + std::string(to_string(event.cause)));
  auto message = to_msg(event, axis_, AxisEventKind::kSafeState);
  message.opened(graph::to_msg(event.time));
  message.closed(graph::to_msg(valve_written));
  event_out_.publish(std::move(message));
}

void AxisReporter::close_spray(const ControllerEvent& event, Time valve_written) {
  furrow_msgs::msg::AxisEvent* message = sprays_.opened();
  if (message == nullptr) return;
  context_.count("sprays");
  message->landing(to_point(event.p_F));
  const Duration open = valve_written - graph::from_msg(message->opened());
  message->volume_ml(event.dry_run ? 0.0 : open.to_seconds() * flow_mlps_);
  sprays_.close(valve_written);
}

void AxisReporter::publish_state(Time now, const actuation::AxisController& controller,
                                 const actuation::AxisReading& reading) {
  if (last_position_m_) travel_m_ += std::abs(reading.position_m - *last_position_m_);
  last_position_m_ = reading.position_m;
  const actuation::ToolSafety& safety = controller.safety();
  cause_time_ = safety.cause_time();
  furrow_msgs::msg::AxisState state;
  state.header(header(now, kBaseFrame));
  state.axis(axis_);
  state.state(msgs::to_msg(drive_state(reading.state)));
  state.position_m(reading.position_m);
  state.velocity_mps(reading.velocity_mps);
  state.travel_m(travel_m_);
  state.mode(msgs::to_msg(axis_mode(safety.mode())));
  state.cause(msgs::to_msg(safety_cause(safety.first_cause())));
  for (const actuation::SafetyCause cause : safety.latched().list()) {
    state.latched().push_back(msgs::to_msg(safety_cause(cause)));
  }
  const actuation::NozzleUse use = controller.use(now);
  state.openings(static_cast<std::uint64_t>(use.openings));
  state.open_s(use.open_s);
  state.volume_ml(use.volume_ml);
  state_ = state;
  state_out_.publish(std::move(state));

  sensor_msgs::msg::JointState joint;
  joint.header(header(now, kBaseFrame));
  joint.name({axis_});
  joint.position({reading.position_m});
  joint.velocity({reading.velocity_mps});
  joint_out_.publish(std::move(joint));
}

void AxisReporter::publish_diagnostics(const std::string& refusal, const std::string& not_confirmed,
                                       const std::string& latches) {
  diagnostics_out_.publish(
      axis_diagnostics(context_.name(), state_, cause_time_, {refusal, not_confirmed, latches}));
}

void AxisReporter::update_health(Time now, const actuation::ToolSafety& safety,
                                 const std::string& refusal, const std::string& not_confirmed) {
  const ControllerMode mode = safety.mode();
  if (mode != ControllerMode::kWaiting) waiting_since_.reset();
  if (mode == ControllerMode::kSafe) {
    set_health(graph::HealthLevel::kError,
               std::string(actuation::to_string(safety.first_cause())) + " at " +
                   fixed(safety.cause_time().to_seconds(), 3) +
                   " s; the axis stopped and the valve is shut until tool/reset");
  } else if (mode == ControllerMode::kWaiting) {
    if (!waiting_since_) waiting_since_ = now;
    const auto missing = safety.missing(now);
    if (now - *waiting_since_ < Duration::milliseconds(1000) || !missing) return;
    set_health(graph::HealthLevel::kWarn,
               refusal.empty() ? "waits for: " + std::string(actuation::to_string(*missing))
                               : "drive: " + refusal);
  } else if (!not_confirmed.empty()) {
    set_health(graph::HealthLevel::kWarn, "not confirmed: " + not_confirmed);
  } else {
    set_health(graph::HealthLevel::kOk, "");
  }
}

void AxisReporter::set_health(graph::HealthLevel level, std::string message) {
  if (level == level_ && message == message_) return;
  level_ = level;
  message_ = std::move(message);
  context_.health(level_, message_);
}

}  // namespace furrow::components
