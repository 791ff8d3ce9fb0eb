#include <memory>
#include <optional>
#include <string>

#include "furrow_components/conversions.hpp"
#include "furrow_components/georeference.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_localization/odometry_integrator.hpp"
#include "furrow_localization/pose_filter.hpp"
#include "furrow_localization/standstill_detector.hpp"
#include "furrow_msgs/tf2_msgs.h"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  std::string estimator = "odometry";
  std::string start = "wheels";
  double speed_variance = 1e-8;
  double yaw_rate_variance = 1e-8;
  double imu_yaw_rate_variance = 2.5e-5;
  double tf_rate_hz = 25.0;
  localization::OdometryIntegratorParameters odometry;
  localization::PoseFilterParameters filter;
  localization::StandstillParameters standstill;
  GeoreferenceParameters georeference;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "estimator",
             .description = "odometry: dead reckoning by the wheels; filter: fusion of wheels, IMU "
                            "and GNSS, as far as they are published",
             .choices = {"odometry", "filter"}},
            estimator);
    v.visit({.name = "start",
             .description = "wheels: at the pose of the first wheel/odometry; parameters: at the "
                            "initial pose of the parameters",
             .choices = {"wheels", "parameters"}},
            start);
    v.visit({.name = "speed_variance",
             .unit = "(m/s)2",
             .description = "of the wheels, where the message has none",
             .min = 0.0},
            speed_variance);
    v.visit({.name = "yaw_rate_variance",
             .unit = "(rad/s)2",
             .description = "of the wheels, where the message has none",
             .min = 0.0},
            yaw_rate_variance);
    v.visit({.name = "imu_yaw_rate_variance",
             .unit = "(rad/s)2",
             .description = "of the gyroscope, where the message has none",
             .min = 0.0},
            imu_yaw_rate_variance);
    v.visit(
        {.name = "tf_rate_hz", .unit = "Hz", .description = "rate of tf", .min = 0.1, .max = 200.0},
        tf_rate_hz);
    odometry.visit(v);
    PrefixedVisitor filter_visitor(v, "filter_");
    filter.visit(filter_visitor);
    PrefixedVisitor standstill_visitor(v, "standstill_");
    standstill.visit(standstill_visitor);
    georeference.visit(v);
  }
};

std::unique_ptr<localization::PoseEstimator> make_estimator(const Parameters& parameters) {
  if (parameters.estimator == "filter") {
    return std::make_unique<localization::PoseFilter>(parameters.filter);
  }
  return std::make_unique<localization::OdometryIntegrator>(parameters.odometry);
}

/// The covariance of the first pose of the wheels: dead reckoning takes it as exact.
Eigen::Matrix3d start_covariance(const Parameters& parameters) {
  if (parameters.estimator != "filter") return Eigen::Matrix3d::Zero();
  const double position_m = parameters.filter.initial_position_sigma_m;
  const double heading_rad = parameters.filter.initial_heading_sigma_rad;
  return Eigen::Vector3d(position_m * position_m, position_m * position_m,
                         heading_rad * heading_rad)
      .asDiagonal();
}

double positive_or(double value, double otherwise) {
  return value > 0.0 ? value : otherwise;
}

graph::HealthLevel to_health(localization::HealthLevel level) {
  switch (level) {
    case localization::HealthLevel::kOk:
      return graph::HealthLevel::kOk;
    case localization::HealthLevel::kDegraded:
      return graph::HealthLevel::kWarn;
    case localization::HealthLevel::kLost:
      break;
  }
  return graph::HealthLevel::kError;
}

/// Estimates the pose of the base in the field frame, at the rate of the wheels.
class Localization final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Estimates the pose of the base in the field frame.")
        .parameters<Parameters>()
        .shared_parameters(GeoreferenceParameters::names())
        .input<topics::WheelOdometry>()
        .input<topics::Imu>(graph::Need::kOptional)
        .input<topics::GnssFix>(graph::Need::kOptional)
        .output<topics::RobotOdometry>()
        .output<topics::Transforms>();
  }

  explicit Localization(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        estimator_(make_estimator(parameters_)),
        standstill_(parameters_.standstill),
        georeference_(parameters_.georeference),
        odometry_out_(context.output<topics::RobotOdometry>()),
        transforms_out_(context.output<topics::Transforms>()) {
    started_ = parameters_.start == "parameters";
    context.input<topics::WheelOdometry>([this](const auto& message) { measured(*message); });
    context.input<topics::Imu>([this](const auto& message) {
      standstill_.add_gyroscope(graph::from_msg(message->header().stamp()),
                                message->angular_velocity().z());
      count("imu_", estimator_->add(localization::ImuYawRate{
                        graph::from_msg(message->header().stamp()), message->angular_velocity().z(),
                        positive_or(message->angular_velocity_covariance()[8],
                                    parameters_.imu_yaw_rate_variance)}));
    });
    context.input<topics::GnssFix>([this](const auto& message) { add(*message); });
    context.every(Duration::seconds(1.0 / parameters_.tf_rate_hz),
                  [this](Time now) { publish_transform(now); });
  }

 private:
  void count(const std::string& sensor, localization::Outcome outcome) {
    if (outcome == localization::Outcome::kUsed) return;
    if (outcome == localization::Outcome::kIgnored) return;
    const std::string reason(localization::to_string(outcome));
    if (outcome == localization::Outcome::kUsedLate) {
      context_.count(sensor + reason);
      return;
    }
    context_.warn(sensor + reason, "a measurement of " + sensor.substr(0, sensor.size() - 1) +
                                       " was " + reason + "; it was not used");
  }

  void add(const sensor_msgs::msg::NavSatFix& fix) {
    const localization::GnssPosition position = georeference_.from_msg(fix);
    // A filter would take fixes of another place on the earth for its own after some repetitions.
    const bool elsewhere = position.p_FA_m.allFinite() &&
                           position.quality != localization::FixQuality::kNone &&
                           !in_field(position.p_FA_m.x(), position.p_FA_m.y());
    const auto outcome = elsewhere ? localization::Outcome::kInvalid : estimator_->add(position);
    switch (outcome) {
      case localization::Outcome::kUsed:
      case localization::Outcome::kUsedLate:
      case localization::Outcome::kRecovered:
        gnss_refusal_.clear();
        if (outcome != localization::Outcome::kUsed) count("gnss_", outcome);
        return;
      case localization::Outcome::kIgnored:
        return;
      default:
        gnss_refusal_ = georeference_.refusal(fix, outcome);
        context_.warn("gnss_" + std::string(localization::to_string(outcome)),
                      gnss_refusal_ + "; it was not used");
    }
  }

  /// The cause where it is known, and the effect. Without numbers, so that it changes rarely.
  [[nodiscard]] std::string uncertainty(const localization::LocalizationHealth& health) const {
    std::string cause;
    if (parameters_.estimator == "filter" && parameters_.filter.use_gnss) {
      if (!gnss_refusal_.empty()) {
        cause = " (" + gnss_refusal_ + ")";
      } else if (health.gnss.used == 0) {
        cause = " (GNSS: no fix was received)";
      } else if (health.gnss_age_s > parameters_.filter.gnss_timeout_s) {
        cause = " (GNSS: no fix was received lately)";
      } else if (health.fix_quality != localization::FixQuality::kRtkFixed) {
        cause = " (GNSS: the quality of the fix is " +
                std::string(localization::to_string(health.fix_quality)) + ", not rtk_fixed)";
      }
    }
    return "the pose is uncertain or old" + cause + "; tools may enter their safe state";
  }

  void measured(const nav_msgs::msg::Odometry& message) {
    const BaseOdometry wheels = from_msg(message);
    // The frame in which the wheels start is the field frame. Only their first pose is used.
    if (!started_) {
      if (!in_field(wheels.X_FB.x_m, wheels.X_FB.y_m)) {
        context_.request_stop(
            context_.name() + ": " + outside_field("wheel/odometry", wheels.X_FB) + " Set " +
            context_.name() + ".start=parameters to start at the initial pose of the parameters");
        return;
      }
      const Status reset =
          estimator_->reset(wheels.stamp, wheels.X_FB, start_covariance(parameters_));
      if (!reset.ok()) {
        context_.warn("rejected", reset.error().message + "; the start pose was not used");
        return;
      }
      started_ = true;
    }
    standstill_.add_wheels(wheels.stamp, wheels.speed_mps, wheels.yaw_rate_radps);
    const auto& variances = message.twist().covariance();
    localization::WheelOdometry measured{wheels.stamp, wheels.speed_mps, wheels.yaw_rate_radps,
                                         positive_or(variances[0], parameters_.speed_variance),
                                         positive_or(variances[35], parameters_.yaw_rate_variance)};
    // Of a robot that stands more is known than its wheels measure.
    if (standstill_.standing()) measured.speed_mps = measured.yaw_rate_radps = 0.0;
    count("wheels_", estimator_->add(measured));
    publish_pose(wheels.stamp);
  }

  void publish_pose(Time stamp) {
    const auto health = estimator_->health(stamp);
    context_.health(to_health(health.level),
                    health.level == localization::HealthLevel::kOk ? "" : uncertainty(health));
    const auto estimate = estimator_->predict(stamp);
    if (!estimate.ok()) {
      context_.warn("no_pose", estimate.error().message + "; no pose was published");
      return;
    }
    newest_ = BaseOdometry{estimate->stamp, estimate->X_FB, estimate->speed_mps,
                           estimate->yaw_rate_radps};
    hold_while_standing();
    nav_msgs::msg::Odometry message = to_msg(newest_, kFieldFrame);
    // Row-major 6x6 over (x, y, z, roll, pitch, yaw), as in ROS.
    constexpr std::size_t kIndex[] = {0, 1, 5};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        message.pose().covariance()[kIndex[row] * 6 + kIndex[column]] =
            estimate->covariance(row, column);
      }
    }
    message.twist().covariance()[0] = estimate->twist_covariance(0, 0);
    message.twist().covariance()[35] = estimate->twist_covariance(1, 1);
    odometry_out_.publish(std::move(message));
    known_ = true;
  }

  // Holds the published pose at standstill, with a twist of zero. Corrections of that time are
  // published when the robot drives on.
  void hold_while_standing() {
    if (!standstill_.standing()) {
      held_.reset();
      return;
    }
    if (!held_) {
      held_ = newest_.X_FB;
      context_.count("standstills");
    }
    newest_.X_FB = *held_;
    newest_.speed_mps = newest_.yaw_rate_radps = 0.0;
  }

  void publish_transform(Time /*now*/) const {
    if (!known_) return;
    tf2_msgs::msg::TFMessage message;
    auto& transform = message.transforms().emplace_back();
    transform.header(header(newest_.stamp, kFieldFrame));
    transform.child_frame_id(kBaseFrame);
    transform.transform().translation().x(newest_.X_FB.x_m);
    transform.transform().translation().y(newest_.X_FB.y_m);
    transform.transform().rotation(to_msg(newest_, kFieldFrame).pose().pose().orientation());
    transforms_out_.publish(std::move(message));
  }

  graph::Context& context_;
  Parameters parameters_;
  std::unique_ptr<localization::PoseEstimator> estimator_;
  localization::StandstillDetector standstill_;
  std::optional<geometry::Pose2> held_;  ///< while the robot stands
  Georeference georeference_;
  std::string gnss_refusal_;  ///< of the newest fix; empty: it was used
  graph::Output<topics::RobotOdometry> odometry_out_;
  graph::Output<topics::Transforms> transforms_out_;
  BaseOdometry newest_;
  bool started_ = false;
  bool known_ = false;  ///< newest_ holds a pose
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::Localization>("localization");
}
