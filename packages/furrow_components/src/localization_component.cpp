#include <memory>
#include <string>

#include "furrow_components/conversions.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_localization/odometry_integrator.hpp"
#include "furrow_localization/pose_filter.hpp"
#include "furrow_msgs/tf2_msgs.h"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  std::string estimator = "odometry";
  double speed_variance = 1e-8;
  double yaw_rate_variance = 1e-8;
  double tf_rate_hz = 25.0;
  localization::OdometryIntegratorParameters odometry;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "estimator",
             .description = "odometry: wheels alone, dead-reckoned",
             .choices = {"odometry"}},
            estimator);
    v.visit({.name = "speed_variance",
             .unit = "(m/s)2",
             .description = "of the wheels, where the message tells none",
             .min = 0.0},
            speed_variance);
    v.visit({.name = "yaw_rate_variance",
             .unit = "(rad/s)2",
             .description = "of the wheels, where the message tells none",
             .min = 0.0},
            yaw_rate_variance);
    v.visit({.name = "tf_rate_hz",
             .unit = "Hz",
             .description = "transforms for viewers",
             .min = 0.1,
             .max = 200.0},
            tf_rate_hz);
    odometry.visit(v);
  }
};

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

/// Where the base is in the field frame, at the rate of the wheels.
class Localization final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Pose of the base in the field frame.")
        .parameters<Parameters>()
        .input<topics::WheelOdometry>()
        .output<topics::RobotOdometry>()
        .output<topics::Transforms>();
  }

  explicit Localization(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        estimator_(std::make_unique<localization::OdometryIntegrator>(parameters_.odometry)),
        odometry_out_(context.output<topics::RobotOdometry>()),
        transforms_out_(context.output<topics::Transforms>()) {
    context.input<topics::WheelOdometry>(
        [this](const auto& message) { measured(from_msg(*message)); });
    context.every(Duration::seconds(1.0 / parameters_.tf_rate_hz),
                  [this](Time now) { publish_transform(now); });
  }

 private:
  void measured(const BaseOdometry& wheels) {
    // The frame that wheels start in is the field frame; only its first pose is taken over.
    if (!started_) {
      const Status reset = estimator_->reset(wheels.stamp, wheels.X_FB, Eigen::Matrix3d::Zero());
      if (!reset.ok()) {
        context_.count("rejected");
        return;
      }
      started_ = true;
    }
    const auto outcome = estimator_->add(
        localization::WheelOdometry{wheels.stamp, wheels.speed_mps, wheels.yaw_rate_radps,
                                    parameters_.speed_variance, parameters_.yaw_rate_variance});
    if (outcome != localization::Outcome::kUsed) context_.count(localization::to_string(outcome));
    const auto health = estimator_->health(wheels.stamp);
    context_.health(to_health(health.level), health.level == localization::HealthLevel::kOk
                                                 ? ""
                                                 : "the pose is uncertain or old");
    const auto estimate = estimator_->predict(wheels.stamp);
    if (!estimate.ok()) {
      context_.count("no_pose");
      return;
    }
    newest_ = BaseOdometry{estimate->stamp, estimate->X_FB, estimate->speed_mps,
                           estimate->yaw_rate_radps};
    nav_msgs::msg::Odometry message = to_msg(newest_, kFieldFrame);
    // Row-major 6x6 over (x, y, z, roll, pitch, yaw), as ROS has it.
    constexpr std::size_t kIndex[] = {0, 1, 5};
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        message.pose().covariance()[kIndex[row] * 6 + kIndex[column]] =
            estimate->covariance(row, column);
      }
    }
    odometry_out_.publish(std::move(message));
  }

  void publish_transform(Time /*now*/) const {
    if (!started_) return;
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
  graph::Output<topics::RobotOdometry> odometry_out_;
  graph::Output<topics::Transforms> transforms_out_;
  BaseOdometry newest_;
  bool started_ = false;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::Localization>("localization");
}
