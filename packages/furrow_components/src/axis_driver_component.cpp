#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "axis_conversion.hpp"
#include "axis_diagnostics.hpp"
#include "axis_driver_parameters.hpp"
#include "furrow_actuation/axis_controller.hpp"
#include "furrow_actuation/drive_supervisor.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_components/nozzle_file.hpp"
#include "furrow_core/text.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "spray_log.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;
using actuation::ControllerEvent;
using actuation::ControllerEventKind;
using msgs::AxisEventKind;

const geometry::AxisModel& find_axis(const geometry::ToolModel& tool, const std::string& name) {
  const auto it = std::ranges::find(tool.axes, name, &geometry::AxisModel::name);
  if (it == tool.axes.end()) throw ConfigError("axis: the tool has no joint '" + name + "'");
  return *it;
}

AxisDriverParameters with_nozzle_file(AxisDriverParameters parameters) {
  if (!parameters.nozzle_file.empty()) {
    parameters.nozzle = load_nozzle(parameters.nozzle_file, parameters.axis);
  }
  return parameters;
}

/// Drives one axis and its nozzle.
class AxisDriverComponent final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("One axis and its nozzle: moves to its stops, fires, and stays safe by itself.")
        .parameters<AxisDriverParameters>()
        .input<topics::Plan>()
        .input<topics::PlannerHeartbeat>()
        .input<topics::RobotOdometry>()
        .input<topics::Tracks>()
        .input<topics::EmergencyStop>(graph::Need::kOptional)
        .input<topics::ToolReset>(graph::Need::kOptional)
        .output<topics::AxisState>()
        .output<topics::AxisEvent>()
        .output<topics::JointStates>()
        .output<topics::Diagnostics>();
  }

  explicit AxisDriverComponent(graph::Context& context)
      : context_(context),
        parameters_(with_nozzle_file(context.parameters<AxisDriverParameters>())),
        axis_(find_axis(geometry::load_tool_model(parameters_.tool_file), parameters_.axis)),
        controller_(axis_, parameters_.nozzle, parameters_.controller),
        driver_(make_axis_driver(parameters_.hardware, actuation::MotionLimits::of(axis_))),
        valve_(make_valve(parameters_.hardware)),
        stop_input_(make_emergency_input(parameters_.hardware)),
        sprays_(Duration::seconds(parameters_.nozzle.close_delay_s)),
        state_out_(context.output<topics::AxisState>()),
        event_out_(context.output<topics::AxisEvent>()),
        joint_out_(context.output<topics::JointStates>()),
        diagnostics_out_(context.output<topics::Diagnostics>()),
        period_(Duration::seconds(1.0 / parameters_.rate_hz)),
        heartbeat_deadline_(Duration::seconds(parameters_.heartbeat_deadline_s)) {
    context.input<topics::Plan>([this](const auto& plan) { take(*plan); });
    context.input<topics::PlannerHeartbeat>(
        [this](const auto&) { last_heartbeat_ = context_.now(); });
    context.input<topics::RobotOdometry>([this](const auto& message) {
      const BaseOdometry base = from_msg(*message);
      controller_.set_odometry({base.stamp, base.X_FB, {base.speed_mps, 0.0, base.yaw_rate_radps}});
      base_x_m_ = base.X_FB.x_m;
    });
    context.input<topics::Tracks>([this](const auto& tracks) { protect(*tracks); });
    context.input<topics::EmergencyStop>(
        [this](const auto& stop) { emergency_stop_ = stop->active(); });
    context.input<topics::ToolReset>([this](const auto& message) {
      if (message->axis().empty() || message->axis() == axis_.name) reset();
    });
    context.every(period_, [this](Time now) { control(now); });
    context.every(Duration::seconds(1.0 / parameters_.state_rate_hz),
                  [this](Time now) { publish_state(now); });
    context.every(Duration::milliseconds(1000), [this](Time) {
      diagnostics_out_.publish(
          axis_diagnostics(context_.name(), state_, cause_time_, supervisor_.refusal()));
    });
  }

 private:
  void take(const furrow_msgs::msg::Plan& plan) {
    const auto route = std::ranges::find_if(
        plan.routes(), [this](const auto& r) { return r.axis() == axis_.name; });
    stops_.clear();
    const Time stamp = graph::from_msg(plan.header().stamp());
    if (route != plan.routes().end()) {
      for (const auto& stop : route->stops()) stops_.push_back(from_msg(stop, stamp));
    }
    // The plan's stamp is that of its newest image; for the deadline it counts when it came.
    if (const Status taken = controller_.set_plan(context_.now(), stops_); !taken.ok()) {
      context_.count("bad_plans");
      context_.health(graph::HealthLevel::kWarn, taken.error().message);
    }
  }

  void protect(const furrow_msgs::msg::Tracks& tracks) {
    protected_.clear();
    const double x_m = base_x_m_ + axis_.p_BN0.x();
    for (const auto& track : tracks.tracks()) {
      const bool crop = track.confirmed() && track.crop_probability() >= parameters_.crop_threshold;
      const Eigen::Vector2d p_F = from_point(track.position()).head<2>();
      if (crop && std::abs(p_F.x() - x_m) <= parameters_.protected_range_m) {
        protected_.push_back({track.id(), p_F});
      }
    }
    controller_.set_protected(protected_);
  }

  void reset() {
    if (!operational(driver_->reading().state)) supervisor_.reset(context_.now());
    reset_pending_ = true;
  }

  static bool operational(actuation::AxisState state) {
    return state == actuation::AxisState::kReady || state == actuation::AxisState::kMoving;
  }

  void control(Time now) {
    if (!driver_->read(now, period_).ok()) context_.count("read_errors");
    supervisor_.update(now, *driver_);
    if (reset_pending_ && !supervisor_.busy()) {
      reset_pending_ = false;
      controller_.set_valve_fault(false);
      controller_.reset();
    }
    controller_.set_reading(driver_->reading());
    controller_.set_emergency_stop(emergency_stop_ || (stop_input_ && stop_input_->pressed()));
    controller_.set_peer_lost(!last_heartbeat_ || now - *last_heartbeat_ > heartbeat_deadline_);
    const actuation::ControllerOutput output = controller_.update(now, period_);
    // First the valve, then the axis.
    if (const Status set = valve_->write(now, output.valve_open); !set.ok()) {
      context_.count("valve_errors");
      controller_.set_valve_fault(true);
    }
    const Time valve_written = context_.now();
    if (!driver_->write(now, period_, output.axis).ok()) context_.count("write_errors");
    mode_ = output.mode;
    cause_ = output.cause;
    cause_time_ = output.cause_time;
    for (std::size_t i = 0; i < output.events.size(); ++i) handle(output.events[i], valve_written);
    if (auto spray = sprays_.sample(now, driver_->reading())) event_out_.publish(std::move(*spray));
    report_start(now);
  }

  /// Until the tool runs for the first time, what it waits for.
  void report_start(Time now) {
    if (mode_ != actuation::ControllerMode::kWaiting) {
      if (waiting_told_ && mode_ == actuation::ControllerMode::kRunning) {
        context_.health(graph::HealthLevel::kOk, "");
      }
      waiting_told_ = false;
      waiting_since_.reset();
      return;
    }
    if (!waiting_since_) waiting_since_ = now;
    if (waiting_told_ || now - *waiting_since_ < Duration::milliseconds(1000)) return;
    waiting_told_ = true;
    const std::string& refusal = supervisor_.refusal();
    context_.health(graph::HealthLevel::kWarn,
                    refusal.empty() ? "waits for plan, odometry and drive" : "drive: " + refusal);
  }

  void handle(const ControllerEvent& event, Time valve_written) {
    switch (event.kind) {
      case ControllerEventKind::kSprayOpened:
        opened(event, valve_written);
        break;
      case ControllerEventKind::kSprayClosed:
        closed(event, valve_written);
        break;
      case ControllerEventKind::kStopSkipped:
        context_.count("skipped_" + std::string(actuation::to_string(event.reason)));
        event_out_.publish(to_msg(event, axis_.name, skip_event(event.reason)));
        break;
      case ControllerEventKind::kMadeSafe:
        entered_safe_state(event, valve_written);
        break;
      case ControllerEventKind::kReset:
        context_.health(graph::HealthLevel::kOk, "");
        event_out_.publish(to_msg(event, axis_.name, AxisEventKind::kReset));
        break;
    }
  }

  void entered_safe_state(const ControllerEvent& event, Time valve_written) {
    const std::string cause(msgs::to_string(safety_cause(event.cause)));
    context_.count("safe_states");
    context_.health(graph::HealthLevel::kError,
                    cause + " at " + fixed(event.time.to_seconds(), 3) +
                        " s; the axis stopped and the valve is shut until tool/reset");
    auto message = to_msg(event, axis_.name, AxisEventKind::kSafeState);
    message.opened(graph::to_msg(event.time));
    message.closed(graph::to_msg(valve_written));
    event_out_.publish(std::move(message));
  }

  void opened(const ControllerEvent& event, Time valve_written) {
    const AxisEventKind kind = event.dry_run ? AxisEventKind::kDryRun : AxisEventKind::kSprayed;
    sprays_.open(to_msg(event, axis_.name, kind), valve_written);
  }

  void closed(const ControllerEvent& event, Time valve_written) {
    furrow_msgs::msg::AxisEvent* message = sprays_.opened();
    if (message == nullptr) return;
    context_.count("sprays");
    message->landing(to_point(event.p_F));
    const Duration open = valve_written - graph::from_msg(message->opened());
    message->volume_ml(event.dry_run ? 0.0 : open.to_seconds() * parameters_.nozzle.flow_mlps);
    sprays_.close(valve_written);
  }

  void publish_state(Time now) {
    const actuation::AxisReading& reading = driver_->reading();
    if (last_position_m_) travel_m_ += std::abs(reading.position_m - *last_position_m_);
    last_position_m_ = reading.position_m;
    furrow_msgs::msg::AxisState state;
    state.header(header(now, kBaseFrame));
    state.axis(axis_.name);
    state.state(msgs::to_msg(drive_state(reading.state)));
    state.position_m(reading.position_m);
    state.velocity_mps(reading.velocity_mps);
    state.travel_m(travel_m_);
    state.mode(msgs::to_msg(axis_mode(mode_)));
    const actuation::NozzleUse use = controller_.use(now);
    state.openings(static_cast<std::uint64_t>(use.openings));
    state.open_s(use.open_s);
    state.volume_ml(use.volume_ml);
    if (mode_ == actuation::ControllerMode::kSafe) {
      state.cause(msgs::to_msg(safety_cause(cause_)));
    }
    state_ = state;
    state_out_.publish(std::move(state));

    sensor_msgs::msg::JointState joint;
    joint.header(header(now, kBaseFrame));
    joint.name({axis_.name});
    joint.position({reading.position_m});
    joint.velocity({reading.velocity_mps});
    joint_out_.publish(std::move(joint));
  }

  graph::Context& context_;
  AxisDriverParameters parameters_;
  geometry::AxisModel axis_;
  actuation::AxisController controller_;
  std::unique_ptr<actuation::AxisDriver> driver_;
  std::unique_ptr<actuation::ValveDriver> valve_;
  std::unique_ptr<actuation::EmergencyInput> stop_input_;  ///< null: there is none
  SprayLog sprays_;
  actuation::DriveSupervisor supervisor_;
  graph::Output<topics::AxisState> state_out_;
  graph::Output<topics::AxisEvent> event_out_;
  graph::Output<topics::JointStates> joint_out_;
  graph::Output<topics::Diagnostics> diagnostics_out_;
  Duration period_;
  Duration heartbeat_deadline_;
  std::optional<Time> last_heartbeat_;
  bool reset_pending_ = false;
  std::optional<Time> waiting_since_;
  bool waiting_told_ = false;
  std::vector<actuation::PlannedStop> stops_;
  std::vector<actuation::ProtectedPlant> protected_;
  double base_x_m_ = 0.0;
  bool emergency_stop_ = false;
  actuation::ControllerMode mode_ = actuation::ControllerMode::kWaiting;
  actuation::SafetyCause cause_ = actuation::SafetyCause::kNone;
  Time cause_time_;
  furrow_msgs::msg::AxisState state_;  ///< last published
  std::optional<double> last_position_m_;
  double travel_m_ = 0.0;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::AxisDriverComponent>("axis_driver");
}
