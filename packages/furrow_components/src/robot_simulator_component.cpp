#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "furrow_components/conversions.hpp"
#include "furrow_components/pose_buffer.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_simulation/robot_motion.hpp"
#include "furrow_simulation/sensors.hpp"
#include "furrow_simulation/spray.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  std::string tool_file;
  double length_m = 20.0;
  double run_in_m = 2.0;
  double run_out_m = 1.0;
  double rate_hz = 100.0;
  simulation::RobotMotionParameters motion;
  simulation::WheelOdometryParameters wheel;
  simulation::SprayParameters spray;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
    v.visit({.name = "length_m",
             .unit = "m",
             .description = "row driven over; a shorter field ends the run earlier",
             .min = 0.5,
             .max = 10000.0},
            length_m);
    v.visit({.name = "run_in_m",
             .unit = "m",
             .description = "start of the base before the field",
             .min = 0.0,
             .max = 100.0},
            run_in_m);
    v.visit({.name = "run_out_m",
             .unit = "m",
             .description = "way of the base beyond the field",
             .min = 0.0,
             .max = 100.0},
            run_out_m);
    v.visit({.name = "rate_hz", .unit = "Hz", .description = "odometry", .min = 1.0, .max = 1000.0},
            rate_hz);
    motion.visit(v);
    PrefixedVisitor wheel_visitor(v, "wheel_");
    wheel.visit(wheel_visitor);
    PrefixedVisitor spray_visitor(v, "spray_");
    spray.visit(spray_visitor);
  }
};

/// The simulated world but for its looks: drives the robot, measures its wheels, and lets what the
/// valves release fall to the ground.
class RobotSimulator final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Simulated robot: true motion, wheel odometry, and where sprays land.")
        .parameters<Parameters>()
        .input<topics::AxisEvent>(graph::Need::kOptional)
        .input<topics::TrueField>(graph::Need::kOptional)
        .output<topics::TrueOdometry>()
        .output<topics::WheelOdometry>()
        .output<topics::TrueSpray>()
        .output<topics::RunStatus>();
  }

  explicit RobotSimulator(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        tool_(geometry::load_tool_model(parameters_.tool_file)),
        truth_(context.output<topics::TrueOdometry>()),
        wheels_out_(context.output<topics::WheelOdometry>()),
        spray_out_(context.output<topics::TrueSpray>()),
        status_out_(context.output<topics::RunStatus>()),
        wheel_(parameters_.wheel, context.seed()),
        length_m_(parameters_.length_m) {
    parameters_.motion.start_x_m = -parameters_.run_in_m;
    for (std::size_t i = 0; i < tool_.axes.size(); ++i) {
      valves_.emplace(tool_.axes[i].name,
                      simulation::SimulatedValve(parameters_.spray, context.seed(), i));
    }
    context.input<topics::TrueField>([this](const auto& field) {
      length_m_ = std::min(parameters_.length_m, field->length_m());
    });
    context.input<topics::AxisEvent>([this](const auto& event) { land(*event); });
    context.every(Duration::seconds(1.0 / parameters_.rate_hz), [this](Time now) { step(now); });
  }

 private:
  void step(Time now) {
    if (motion_ == nullptr) {
      motion_ = std::make_unique<simulation::RobotMotion>(parameters_.motion, context_.seed(), now);
      reckoned_ = motion_->state().X_FB;
      last_ = now;
    }
    const simulation::RobotState& state = motion_->advance_to(now);
    const BaseOdometry truth{now, state.X_FB, state.speed_mps, state.yaw_rate_radps};
    if (const Status added = truth_buffer_.add(truth); !added.ok()) return;
    truth_.publish(to_msg(truth, kFieldFrame));

    const simulation::WheelReading reading = wheel_.measure(state);
    reckon(reading, now);
    wheels_out_.publish(
        to_msg(BaseOdometry{now, reckoned_, reading.speed_mps, reading.yaw_rate_radps}, "odom"));
    report(state, now);
  }

  // The pose that wheels alone would tell, in a frame that starts as the field frame.
  void reckon(const simulation::WheelReading& reading, Time now) {
    const double dt_s = (now - last_).to_seconds();
    const double turn_rad = reading.yaw_rate_radps * dt_s;
    const double way_m = reading.speed_mps * dt_s;
    reckoned_ = geometry::compose(
        reckoned_, {way_m * std::cos(0.5 * turn_rad), way_m * std::sin(0.5 * turn_rad), turn_rad});
    last_ = now;
  }

  void report(const simulation::RobotState& state, Time now) {
    const double end_m = length_m_ + parameters_.run_out_m;
    const double way_m = state.X_FB.x_m + parameters_.run_in_m;
    const bool finished = state.X_FB.x_m >= end_m;
    constexpr int kStepsPerReport = 20;
    if (finished_ || (!finished && ++steps_ % kStepsPerReport != 0)) return;
    finished_ = finished;
    furrow_msgs::msg::RunStatus status;
    status.header(header(now, kFieldFrame));
    status.finished(finished);
    status.progress(std::clamp(way_m / (end_m + parameters_.run_in_m), 0.0, 1.0));
    status.distance_m(way_m);
    status.speed_mps(state.speed_mps);
    status_out_.publish(std::move(status));
  }

  void land(const furrow_msgs::msg::AxisEvent& event) {
    if (event.event() != "sprayed") return;
    const auto axis = std::ranges::find(tool_.axes, event.axis(), &geometry::AxisModel::name);
    if (axis == tool_.axes.end()) {
      context_.count("events_of_unknown_axes");
      return;
    }
    const auto window =
        valves_.at(event.axis())
            .actuate(graph::from_msg(event.opened()), graph::from_msg(event.closed()));
    if (!window || !window->close) {
      context_.count("openings_without_spray");
      return;
    }
    const auto at_open = nozzle(*axis, window->open, graph::from_msg(event.opened()),
                                event.position_opened_m(), event.velocity_opened_mps());
    const auto at_close = nozzle(*axis, *window->close, graph::from_msg(event.closed()),
                                 event.position_closed_m(), event.velocity_closed_mps());
    if (!at_open || !at_close) {
      context_.count("sprays_outside_the_memory");
      return;
    }
    publish(event,
            simulation::spray_patch(*at_open, *at_close, axis->nozzle.height_m, parameters_.spray),
            axis->nozzle.footprint_radius_m);
  }

  void publish(const furrow_msgs::msg::AxisEvent& event, const simulation::SprayPatch& patch,
               double radius_m) const {
    furrow_msgs::msg::TrueSpray spray;
    spray.header(header(patch.time, kFieldFrame));
    spray.axis(event.axis());
    spray.stop_id(event.stop_id());
    spray.track_ids(event.track_ids());
    spray.aim(event.aim());
    spray.centre(to_point(patch.p_F_m));
    spray.radius_m(radius_m);
    spray_out_.publish(std::move(spray));
  }

  // The nozzle over the true ground, when the axis was at `q_m` at the time of the command.
  [[nodiscard]] std::optional<simulation::NozzleState> nozzle(const geometry::AxisModel& axis,
                                                              Time time, Time commanded, double q_m,
                                                              double qd_mps) const {
    const auto base = truth_buffer_.at(time, Duration::seconds(2.0 / parameters_.rate_hz));
    if (!base.ok()) return std::nullopt;
    const double moved_q_m = q_m + qd_mps * (time - commanded).to_seconds();
    const Eigen::Vector2d p_B = axis.nozzle_position_B(moved_q_m).head<2>();
    const Eigen::Vector2d v_B = Eigen::Vector2d(base->speed_mps, 0.0) +
                                base->yaw_rate_radps * Eigen::Vector2d(-p_B.y(), p_B.x()) +
                                qd_mps * axis.direction_B.head<2>();
    const Eigen::Rotation2Dd R_FB(base->X_FB.heading_rad);
    return simulation::NozzleState{time, geometry::transform(base->X_FB, p_B), R_FB * v_B};
  }

  graph::Context& context_;
  Parameters parameters_;
  geometry::ToolModel tool_;
  graph::Output<topics::TrueOdometry> truth_;
  graph::Output<topics::WheelOdometry> wheels_out_;
  graph::Output<topics::TrueSpray> spray_out_;
  graph::Output<topics::RunStatus> status_out_;
  simulation::WheelOdometry wheel_;
  std::unique_ptr<simulation::RobotMotion> motion_;
  PoseBuffer truth_buffer_{Duration::seconds(2.0)};
  std::map<std::string, simulation::SimulatedValve> valves_;
  geometry::Pose2 reckoned_;
  Time last_;
  double length_m_ = 0.0;
  int steps_ = 0;
  bool finished_ = false;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::RobotSimulator>("robot_simulator");
}
