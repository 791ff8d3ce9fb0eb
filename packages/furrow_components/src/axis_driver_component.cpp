#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_actuation/axis_controller.hpp"
#include "furrow_actuation/simulated_axis_driver.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;
using actuation::ControllerEvent;
using actuation::ControllerEventKind;

struct Parameters {
  std::string tool_file;
  std::string axis;
  std::string driver = "simulated";
  double rate_hz = 500.0;
  double state_rate_hz = 50.0;
  double crop_threshold = 0.5;
  double protected_range_m = 1.0;
  actuation::AxisControllerParameters controller;
  actuation::NozzleCalibration nozzle;
  actuation::SimulatedAxisParameters simulated{.start_ready = true};

  void visit(ParameterVisitor& v) {
    v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
    v.visit({.name = "axis", .description = "joint of the URDF that is driven"}, axis);
    v.visit({.name = "driver",
             .description = "simulated: a servo within the URDF's limits",
             .choices = {"simulated"}},
            driver);
    v.visit({.name = "rate_hz",
             .unit = "Hz",
             .description = "control loop",
             .min = 10.0,
             .max = 5000.0},
            rate_hz);
    v.visit({.name = "state_rate_hz",
             .unit = "Hz",
             .description = "published states",
             .min = 1.0,
             .max = 1000.0},
            state_rate_hz);
    v.visit({.name = "crop_threshold",
             .description = "tracks at or above this probability are protected",
             .min = 0.0,
             .max = 1.0},
            crop_threshold);
    v.visit({.name = "protected_range_m",
             .unit = "m",
             .description = "crops this far before and behind the axis are watched",
             .min = 0.1,
             .max = 10.0},
            protected_range_m);
    controller.visit(v);
    PrefixedVisitor nozzle_visitor(v, "nozzle_");
    nozzle.visit(nozzle_visitor);
    PrefixedVisitor simulated_visitor(v, "simulated_");
    simulated.visit(simulated_visitor);
  }
};

const geometry::AxisModel& find_axis(const geometry::ToolModel& tool, const std::string& name) {
  const auto it = std::ranges::find(tool.axes, name, &geometry::AxisModel::name);
  if (it == tool.axes.end()) throw ConfigError("axis: the tool has no joint '" + name + "'");
  return *it;
}

/// What the ledger calls it when a stop was not sprayed.
std::string reason_name(actuation::SkipReason reason) {
  using actuation::SkipReason;
  switch (reason) {
    case SkipReason::kNone:
      return "sprayed";
    case SkipReason::kLate:
    case SkipReason::kUnreachable:
      return "unreachable";
    case SkipReason::kStale:
      return "stale";
    case SkipReason::kProtectedCrop:
      return "protected_crop";
    case SkipReason::kFault:
    case SkipReason::kStanding:
      break;
  }
  return "fault";
}

/// Drives one axis and its nozzle.
class AxisDriverComponent final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("One axis and its nozzle: moves to its stops, fires, and stays safe by itself.")
        .parameters<Parameters>()
        .input<topics::Plan>()
        .input<topics::RobotOdometry>()
        .input<topics::Tracks>()
        .input<topics::EmergencyStop>(graph::Need::kOptional)
        .output<topics::AxisState>()
        .output<topics::AxisEvent>()
        .output<topics::JointStates>();
  }

  explicit AxisDriverComponent(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        axis_(find_axis(geometry::load_tool_model(parameters_.tool_file), parameters_.axis)),
        controller_(axis_, parameters_.nozzle, parameters_.controller),
        driver_(std::make_unique<actuation::SimulatedAxisDriver>(actuation::MotionLimits::of(axis_),
                                                                 parameters_.simulated)),
        state_out_(context.output<topics::AxisState>()),
        event_out_(context.output<topics::AxisEvent>()),
        joint_out_(context.output<topics::JointStates>()),
        period_(Duration::seconds(1.0 / parameters_.rate_hz)) {
    context.input<topics::Plan>([this](const auto& plan) { take(*plan); });
    context.input<topics::RobotOdometry>([this](const auto& message) {
      const BaseOdometry base = from_msg(*message);
      controller_.set_odometry({base.stamp, base.X_FB, {base.speed_mps, 0.0, base.yaw_rate_radps}});
      base_x_m_ = base.X_FB.x_m;
    });
    context.input<topics::Tracks>([this](const auto& tracks) { protect(*tracks); });
    context.input<topics::EmergencyStop>(
        [this](const auto& stop) { controller_.set_emergency_stop(stop->active()); });
    context.every(period_, [this](Time now) { control(now); });
    context.every(Duration::seconds(1.0 / parameters_.state_rate_hz),
                  [this](Time now) { publish_state(now); });
  }

 private:
  void take(const furrow_msgs::msg::Plan& plan) {
    const auto route = std::ranges::find_if(
        plan.routes(), [this](const auto& r) { return r.axis() == axis_.name; });
    stops_.clear();
    const Time stamp = graph::from_msg(plan.header().stamp());
    if (route != plan.routes().end()) {
      for (const auto& stop : route->stops()) stops_.push_back(to_stop(stop, stamp));
    }
    // The plan's stamp is that of its newest image; for the deadline it counts when it came.
    if (const Status taken = controller_.set_plan(context_.now(), stops_); !taken.ok()) {
      context_.count("bad_plans");
      context_.health(graph::HealthLevel::kWarn, taken.error().message);
    }
  }

  static actuation::PlannedStop to_stop(const furrow_msgs::msg::Stop& message, Time observed) {
    actuation::PlannedStop stop;
    stop.stop_id = message.id();
    stop.p_F = from_point(message.aim()).head<2>();
    for (const std::int64_t track : message.track_ids()) stop.targets.push_back(track);
    stop.intended = graph::from_msg(message.expected());
    stop.observed = observed;
    stop.fire_while_moving = message.while_moving();
    return stop;
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

  void control(Time now) {
    if (!driver_->read(now, period_).ok()) context_.count("read_errors");
    controller_.set_reading(driver_->reading());
    const actuation::ControllerOutput output = controller_.update(now, period_);
    if (output.axis.mode != actuation::AxisCommandMode::kNone &&
        !driver_->write(now, period_, output.axis).ok()) {
      context_.count("write_errors");
    }
    for (std::size_t i = 0; i < output.events.size(); ++i) handle(output.events[i]);
    mode_ = output.mode;
    cause_ = output.cause;
  }

  void handle(const ControllerEvent& event) {
    switch (event.kind) {
      case ControllerEventKind::kSprayOpened:
        opened_ = event;
        opened_velocity_mps_ = driver_->reading().velocity_mps;
        break;
      case ControllerEventKind::kSprayClosed:
        sprayed(event);
        break;
      case ControllerEventKind::kStopSkipped:
        context_.count("skipped_" + std::string(actuation::to_string(event.reason)));
        event_out_.publish(to_msg(event, reason_name(event.reason)));
        break;
      case ControllerEventKind::kMadeSafe:
        context_.count("made_safe");
        context_.health(graph::HealthLevel::kError, actuation::to_string(event.cause));
        break;
      case ControllerEventKind::kReset:
        context_.health(graph::HealthLevel::kOk, "");
        break;
    }
  }

  void sprayed(const ControllerEvent& closed) {
    if (!opened_) return;
    const ControllerEvent opened = *std::exchange(opened_, std::nullopt);
    context_.count("sprays");
    // A spray that was only acted out treats nothing.
    auto message = to_msg(opened, opened.dry_run ? "dry_run" : "sprayed");
    message.header(header(closed.time, kFieldFrame));
    message.opened(graph::to_msg(opened.time));
    message.closed(graph::to_msg(closed.time));
    message.position_opened_m(opened.q_m);
    message.velocity_opened_mps(opened_velocity_mps_);
    message.position_closed_m(closed.q_m);
    message.velocity_closed_mps(driver_->reading().velocity_mps);
    event_out_.publish(std::move(message));
  }

  [[nodiscard]] furrow_msgs::msg::AxisEvent to_msg(const ControllerEvent& event,
                                                   const std::string& what) const {
    furrow_msgs::msg::AxisEvent message;
    message.header(header(event.time, kFieldFrame));
    message.axis(axis_.name);
    message.event(what);
    message.stop_id(event.stop_id);
    for (std::size_t i = 0; i < event.targets.size(); ++i) {
      message.track_ids().push_back(event.targets[i]);
    }
    message.aim(to_point(event.aim_F));
    return message;
  }

  void publish_state(Time now) {
    const actuation::AxisReading& reading = driver_->reading();
    if (last_position_m_) travel_m_ += std::abs(reading.position_m - *last_position_m_);
    last_position_m_ = reading.position_m;
    furrow_msgs::msg::AxisState state;
    state.header(header(now, kBaseFrame));
    state.axis(axis_.name);
    state.state(std::string(actuation::to_string(reading.state)));
    state.position_m(reading.position_m);
    state.velocity_mps(reading.velocity_mps);
    state.travel_m(travel_m_);
    if (mode_ == actuation::ControllerMode::kSafe) {
      state.fault(std::string(actuation::to_string(cause_)));
    }
    state_out_.publish(std::move(state));

    sensor_msgs::msg::JointState joint;
    joint.header(header(now, kBaseFrame));
    joint.name({axis_.name});
    joint.position({reading.position_m});
    joint.velocity({reading.velocity_mps});
    joint_out_.publish(std::move(joint));
  }

  graph::Context& context_;
  Parameters parameters_;
  geometry::AxisModel axis_;
  actuation::AxisController controller_;
  std::unique_ptr<actuation::AxisDriver> driver_;
  graph::Output<topics::AxisState> state_out_;
  graph::Output<topics::AxisEvent> event_out_;
  graph::Output<topics::JointStates> joint_out_;
  Duration period_;
  std::vector<actuation::PlannedStop> stops_;
  std::vector<actuation::ProtectedPlant> protected_;
  double base_x_m_ = 0.0;
  std::optional<ControllerEvent> opened_;
  double opened_velocity_mps_ = 0.0;
  actuation::ControllerMode mode_ = actuation::ControllerMode::kWaiting;
  actuation::SafetyCause cause_ = actuation::SafetyCause::kNone;
  std::optional<double> last_position_m_;
  double travel_m_ = 0.0;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::AxisDriverComponent>("axis_driver");
}
