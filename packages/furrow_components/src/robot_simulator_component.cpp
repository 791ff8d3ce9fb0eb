#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "furrow_components/conversions.hpp"
#include "furrow_components/georeference.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_simulation/robot_motion.hpp"
#include "furrow_simulation/sensors.hpp"
#include "furrow_simulation/spray.hpp"
#include "spray_landing.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  std::string tool_file;
  double length_m = 20.0;
  double run_in_m = 2.0;
  double run_out_m = 1.0;
  double rate_hz = 100.0;
  double imu_rate_hz = 100.0;
  double gnss_rate_hz = 5.0;
  bool follow_speed_requests = false;
  double speed_request_timeout_s = 0.5;
  simulation::RobotMotionParameters motion;
  simulation::WheelOdometryParameters wheel;
  simulation::ImuParameters imu;
  simulation::GnssParameters gnss;
  GeoreferenceParameters georeference;
  simulation::SprayParameters spray;
  simulation::ValveFaultParameters valve_faults;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
    v.visit({.name = "length_m",
             .unit = "m",
             .description = "length of the row; a shorter field ends the run earlier",
             .min = 0.5,
             .max = 10000.0},
            length_m);
    v.visit({.name = "run_in_m",
             .unit = "m",
             .description = "start of the base ahead of the field",
             .min = 0.0,
             .max = 100.0},
            run_in_m);
    v.visit({.name = "run_out_m",
             .unit = "m",
             .description = "distance of the base beyond the field",
             .min = 0.0,
             .max = 100.0},
            run_out_m);
    visit_rates(v);
    v.visit({.name = "follow_speed_requests",
             .description = "follow robot/speed_request, never faster than speed_mps"},
            follow_speed_requests);
    v.visit({.name = "speed_request_timeout_s",
             .unit = "s",
             .description = "without a request for this long the robot returns to speed_mps",
             .min = 0.02,
             .max = 60.0},
            speed_request_timeout_s);
    motion.visit(v);
    PrefixedVisitor wheel_visitor(v, "wheel_");
    wheel.visit(wheel_visitor);
    PrefixedVisitor imu_visitor(v, "imu_");
    imu.visit(imu_visitor);
    PrefixedVisitor gnss_visitor(v, "gnss_");
    gnss.visit(gnss_visitor);
    georeference.visit(v);
    PrefixedVisitor spray_visitor(v, "spray_");
    spray.visit(spray_visitor);
    PrefixedVisitor fault_visitor(v, "valve_fault_");
    valve_faults.visit(fault_visitor);
  }

 private:
  void visit_rates(ParameterVisitor& v) {
    v.visit({.name = "rate_hz",
             .unit = "Hz",
             .description = "rate of the odometry",
             .min = 1.0,
             .max = 1000.0},
            rate_hz);
    v.visit({.name = "imu_rate_hz",
             .unit = "Hz",
             .description = "rate of the inertial measurements",
             .min = 1.0,
             .max = 1000.0},
            imu_rate_hz);
    v.visit({.name = "gnss_rate_hz",
             .unit = "Hz",
             .description = "rate of the positions of the antenna",
             .min = 0.1,
             .max = 100.0},
            gnss_rate_hz);
  }
};

localization::FixQuality quality_of(simulation::GnssQuality quality) {
  switch (quality) {
    case simulation::GnssQuality::kNone:
      return localization::FixQuality::kNone;
    case simulation::GnssQuality::kSingle:
      return localization::FixQuality::kSingle;
    case simulation::GnssQuality::kFloat:
      return localization::FixQuality::kRtkFloat;
    case simulation::GnssQuality::kFixed:
      break;
  }
  return localization::FixQuality::kRtkFixed;
}

double squared(double value) {
  return value * value;
}

/// Simulates the motion of the robot, its wheel odometry, IMU and GNSS, and the landing of sprays.
class RobotSimulator final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Simulates the robot: true motion, wheel odometry, IMU, GNSS, landing of sprays.")
        .parameters<Parameters>()
        .shared_parameters(GeoreferenceParameters::names())
        .input<topics::AxisEvent>(graph::Need::kOptional)
        .input<topics::AxisState>(graph::Need::kOptional)
        .input<topics::TrueField>(graph::Need::kOptional)
        .input<topics::SpeedRequest>(graph::Need::kOptional)
        .output<topics::TrueOdometry>()
        .output<topics::WheelOdometry>()
        .output<topics::Imu>()
        .output<topics::GnssFix>()
        .output<topics::TrueSpray>()
        .output<topics::RunStatus>();
  }

  explicit RobotSimulator(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        landing_(context, geometry::load_tool_model(parameters_.tool_file), parameters_.spray,
                 parameters_.valve_faults, Duration::seconds(2.0 / parameters_.rate_hz)),
        truth_(context.output<topics::TrueOdometry>()),
        wheels_out_(context.output<topics::WheelOdometry>()),
        imu_out_(context.output<topics::Imu>()),
        gnss_out_(context.output<topics::GnssFix>()),
        status_out_(context.output<topics::RunStatus>()),
        georeference_(parameters_.georeference),
        wheel_(parameters_.wheel, context.seed()),
        imu_(parameters_.imu, context.seed()),
        gnss_(parameters_.gnss, context.seed()),
        length_m_(parameters_.length_m) {
    parameters_.motion.start_x_m = -parameters_.run_in_m;
    context.input<topics::TrueField>([this](const auto& field) {
      length_m_ = std::min(parameters_.length_m, field->length_m());
    });
    context.input<topics::AxisEvent>([this](const auto& event) { landing_.take(*event); });
    context.input<topics::AxisState>([this](const auto& state) { landing_.take(*state); });
    context.input<topics::SpeedRequest>([this](const auto& request) { take(*request); });
    context.every(Duration::seconds(1.0 / parameters_.rate_hz), [this](Time now) { step(now); });
    context.every(Duration::seconds(1.0 / parameters_.imu_rate_hz),
                  [this](Time now) { measure_turning(now); });
    context.every(Duration::seconds(1.0 / parameters_.gnss_rate_hz),
                  [this](Time now) { measure_position(now); });
  }

 private:
  void take(const geometry_msgs::msg::TwistStamped& request) {
    if (!parameters_.follow_speed_requests) return;
    const double speed_mps = request.twist().linear().x();
    if (!std::isfinite(speed_mps) || speed_mps < 0.0) {
      context_.warn("bad_speed_requests",
                    "the requested speed is negative or not finite; it was ignored");
      return;
    }
    asked_ = {graph::from_msg(request.header().stamp()), speed_mps};
  }

  // A tool that is silent, or whose clock differs, does not hold the robot up.
  void follow_request(Time now) {
    if (!parameters_.follow_speed_requests || !asked_) return;
    const Duration timeout = Duration::seconds(parameters_.speed_request_timeout_s);
    const bool fresh = now - asked_->stamp <= timeout && asked_->stamp - now <= timeout;
    motion_->limit_speed(fresh ? std::optional(asked_->speed_mps) : std::nullopt);
    if (fresh != request_lost_) return;
    request_lost_ = !fresh;
    if (request_lost_) {
      context_.count("speed_requests_lost");
      context_.health(graph::HealthLevel::kWarn,
                      "no speed request received; the robot returns to its own speed");
    } else {
      context_.health(graph::HealthLevel::kOk, "");
    }
  }

  void step(Time now) {
    if (motion_ == nullptr) {
      motion_ = std::make_unique<simulation::RobotMotion>(parameters_.motion, context_.seed(), now);
      reckoned_ = motion_->state().X_FB;
      last_ = now;
    }
    follow_request(now);
    const simulation::RobotState& state = motion_->advance_to(now);
    nav_msgs::msg::Odometry truth =
        to_msg(BaseOdometry{now, state.X_FB, state.speed_mps, state.yaw_rate_radps}, kFieldFrame);
    if (!landing_.move(truth)) return;
    truth_.publish(std::move(truth));

    const simulation::WheelReading reading = wheel_.measure(state);
    reckon(reading, now);
    nav_msgs::msg::Odometry wheels =
        to_msg(BaseOdometry{now, reckoned_, reading.speed_mps, reading.yaw_rate_radps}, "odom");
    // In the 6x6 over (x, y, z, roll, pitch, yaw): the variances of speed and yaw rate.
    wheels.twist().covariance()[0] = squared(parameters_.wheel.speed_noise_mps);
    wheels.twist().covariance()[35] = squared(parameters_.wheel.yaw_rate_noise_radps);
    wheels_out_.publish(std::move(wheels));
    hand_out_positions(now);
    report(state, now);
  }

  void measure_turning(Time now) {
    if (motion_ == nullptr) return;
    const simulation::ImuReading reading = imu_.measure(motion_->advance_to(now));
    sensor_msgs::msg::Imu message;
    message.header(header(reading.time, kBaseFrame));
    message.orientation_covariance()[0] = -1.0;  // by the message's rule: no orientation
    message.angular_velocity().x(reading.angular_velocity_B_radps.x());
    message.angular_velocity().y(reading.angular_velocity_B_radps.y());
    message.angular_velocity().z(reading.angular_velocity_B_radps.z());
    message.linear_acceleration().x(reading.acceleration_B_mps2.x());
    message.linear_acceleration().y(reading.acceleration_B_mps2.y());
    message.linear_acceleration().z(reading.acceleration_B_mps2.z());
    for (const std::size_t i : {0, 4, 8}) {
      message.angular_velocity_covariance()[i] = squared(parameters_.imu.gyro_noise_radps);
      message.linear_acceleration_covariance()[i] =
          squared(parameters_.imu.accelerometer_noise_mps2);
    }
    imu_out_.publish(std::move(message));
  }

  void measure_position(Time now) {
    if (motion_ == nullptr) return;
    if (const auto reading = gnss_.measure(motion_->advance_to(now))) {
      positions_.push_back(*reading);
    }
    hand_out_positions(now);
  }

  // The receiver publishes late, with the stamp of the measurement.
  void hand_out_positions(Time now) {
    while (!positions_.empty() && positions_.front().available <= now) {
      const simulation::GnssReading& reading = positions_.front();
      gnss_out_.publish(georeference_.to_msg(
          {.stamp = reading.time,
           .p_FA_m = reading.p_F_m,
           .quality = quality_of(reading.quality),
           .covariance = Eigen::Matrix2d::Identity() * squared(reading.standard_deviation_m)}));
      positions_.pop_front();
    }
  }

  // Dead reckoning by the wheels, from the true start in the field frame.
  void reckon(const simulation::WheelReading& reading, Time now) {
    reckoned_ = geometry::extrapolate(reckoned_, {reading.speed_mps, 0.0, reading.yaw_rate_radps},
                                      (now - last_).to_seconds());
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

  struct SpeedRequest {
    Time stamp;
    double speed_mps = 0.0;
  };

  graph::Context& context_;
  Parameters parameters_;
  SprayLanding landing_;
  graph::Output<topics::TrueOdometry> truth_;
  graph::Output<topics::WheelOdometry> wheels_out_;
  graph::Output<topics::Imu> imu_out_;
  graph::Output<topics::GnssFix> gnss_out_;
  graph::Output<topics::RunStatus> status_out_;
  Georeference georeference_;
  simulation::WheelOdometry wheel_;
  simulation::Imu imu_;
  simulation::Gnss gnss_;
  std::deque<simulation::GnssReading> positions_;  ///< measured, not published yet
  std::unique_ptr<simulation::RobotMotion> motion_;
  std::optional<SpeedRequest> asked_;
  bool request_lost_ = false;
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
