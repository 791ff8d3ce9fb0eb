#pragma once

#include <cmath>
#include <opencv2/core.hpp>

#include "furrow_components/conversions.hpp"
#include "furrow_components/georeference.hpp"
#include "furrow_components/image_conversions.hpp"

namespace furrow::diagnosis {

/// Messages of the drivers of a sound robot that fits urdf/bonnbot.urdf and drives a circle.
class SensorMessages {
 public:
  explicit SensorMessages(Time start) : start_(start), colour_(960, 1280, CV_8UC3) {
    cv::randu(colour_, 0, 255);
  }

  [[nodiscard]] sensor_msgs::msg::Image image(Time stamp) const {
    return components::to_msg(colour_, stamp, components::kCameraFrame);
  }
  [[nodiscard]] sensor_msgs::msg::CameraInfo camera_info(Time stamp) const {
    return components::to_msg({1280, 960, 870.0, 870.0, 639.5, 479.5}, stamp);
  }
  /// `units` for the metre from the camera to the ground.
  [[nodiscard]] sensor_msgs::msg::Image depth(Time stamp, int units = 1000) const {
    return components::to_msg(cv::Mat(960, 1280, CV_16UC1, cv::Scalar(units)), stamp,
                              components::kCameraFrame);
  }
  [[nodiscard]] nav_msgs::msg::Odometry wheels(Time stamp) const {
    components::BaseOdometry base;
    base.stamp = stamp;
    base.X_FB = pose(stamp);
    base.speed_mps = kSpeed_mps;
    base.yaw_rate_radps = kYawRate_radps;
    return components::to_msg(base, "odom");
  }
  [[nodiscard]] sensor_msgs::msg::Imu imu(Time stamp) const {
    sensor_msgs::msg::Imu message;
    message.header(components::header(stamp, "imu"));
    message.angular_velocity().z(kYawRate_radps);
    message.linear_acceleration().z(9.81);
    return message;
  }
  [[nodiscard]] sensor_msgs::msg::NavSatFix fix(Time stamp) const {
    localization::GnssPosition position;
    position.stamp = stamp;
    position.p_FA_m = {pose(stamp).x_m, pose(stamp).y_m};
    position.covariance = 1e-4 * Eigen::Matrix2d::Identity();
    return components::Georeference({}).to_msg(position);
  }

 private:
  static constexpr double kSpeed_mps = 0.5;
  static constexpr double kYawRate_radps = 0.3;

  [[nodiscard]] geometry::Pose2 pose(Time stamp) const {
    const double yaw_rad = kYawRate_radps * (stamp - start_).to_seconds();
    const double radius_m = kSpeed_mps / kYawRate_radps;
    return {radius_m * std::sin(yaw_rad), radius_m * (1.0 - std::cos(yaw_rad)), yaw_rad};
  }

  Time start_;
  cv::Mat colour_;
};

}  // namespace furrow::diagnosis
