#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "furrow_diagnosis/observation.hpp"

namespace furrow::diagnosis {

inline constexpr double kSeconds = 5.0;
inline const Time kStart = Time::from_seconds(1.8e9);

/// A camera 1 m above the ground that looks straight down.
inline geometry::CameraModel camera_above_ground() {
  geometry::CameraModel camera;
  camera.link = "camera_optical";
  camera.intrinsics = {1280, 960, 870.0, 870.0, 639.5, 479.5};
  camera.X_BC = Eigen::Translation3d(1.2, 0.0, 1.0) *
                Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX());
  return camera;
}

/// The pose of a robot that drives a sine at `t_s`.
struct Drive {
  double t_s = 0.0;
  [[nodiscard]] double speed_mps() const { return 0.5; }
  [[nodiscard]] double yaw_rad() const { return 0.3 * (1.0 - std::cos(t_s)); }
  [[nodiscard]] double yaw_rate_radps() const { return 0.3 * std::sin(t_s); }
};

inline TopicObservation sound_topic(const std::string& name, Role role, const std::string& type,
                                    double rate_hz, const std::string& frame) {
  TopicObservation topic;
  topic.topic = name;
  topic.role = role;
  topic.type = type;
  topic.readers = "reader";
  topic.required = true;
  topic.writers = {{"driver", type, ""}};
  topic.frame = frame;
  for (int i = 0; i < static_cast<int>(kSeconds * rate_hz); ++i) {
    const Time stamp = kStart + Duration::seconds(i / rate_hz);
    topic.times.push_back(
        {stamp, stamp + Duration::milliseconds(10), stamp + Duration::milliseconds(11)});
  }
  topic.messages = topic.times.size();
  return topic;
}

/// Observations in which nothing is wrong.
inline Observations sound_sensors() {
  Observations seen;
  seen.seconds = kSeconds;
  const std::string image = "sensor_msgs/msg/Image";
  seen.topics = {
      sound_topic("camera/image", Role::kImage, image, 3.0, "camera_optical"),
      sound_topic("camera/camera_info", Role::kCameraInfo, "sensor_msgs/msg/CameraInfo", 3.0,
                  "camera_optical"),
      sound_topic("camera/depth", Role::kDepth, image, 3.0, "camera_optical"),
      sound_topic("wheel/odometry", Role::kWheels, "nav_msgs/msg/Odometry", 50.0, "odom"),
      sound_topic("imu/data", Role::kImu, "sensor_msgs/msg/Imu", 100.0, "imu"),
      sound_topic("gnss/fix", Role::kGnss, "sensor_msgs/msg/NavSatFix", 5.0, "gnss")};
  seen.image = ImageObservation{1280, 960, "bgr8", "", false, false};
  seen.calibration = CalibrationObservation{camera_above_ground().intrinsics, ""};
  seen.depth = DepthObservation{1280, 960, "16UC1", "", 0.98};
  seen.wheels_child_frame = "base_link";
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  for (const MessageTimes& times : seen.topics[3].times) {
    const Drive drive{(times.stamp - kStart).to_seconds()};
    seen.wheels.push_back({times.stamp, times.arrival, position_m, drive.yaw_rad(),
                           drive.speed_mps(), drive.yaw_rate_radps()});
    position_m += drive.speed_mps() / 50.0 *
                  Eigen::Vector2d(std::cos(drive.yaw_rad()), std::sin(drive.yaw_rad()));
  }
  for (const MessageTimes& times : seen.topics[4].times) {
    const Drive drive{(times.stamp - kStart).to_seconds()};
    seen.imu.push_back({times.arrival, {0.0, 0.0, drive.yaw_rate_radps()}, {0.1, -0.1, 9.8}});
  }
  // Ten samples of the wheels a fix.
  for (std::size_t i = 0; i < seen.topics[5].times.size(); ++i) {
    seen.gnss.push_back({seen.topics[5].times[i].arrival, 50.615, 6.987, 170.0, 2, true,
                         1e-4 * Eigen::Matrix2d::Identity(), seen.wheels[10 * i].position_m});
  }
  return seen;
}

inline Expectation sound_expectation() {
  Expectation expected;
  expected.camera = camera_above_ground();
  return expected;
}

/// Places in Observations::topics of sound_sensors().
enum Input : std::size_t { kImage, kInfo, kDepth, kWheels, kImu, kGnss };

inline void shift_stamps(TopicObservation& topic, double seconds) {
  for (MessageTimes& times : topic.times) times.stamp += Duration::seconds(seconds);
}
inline void for_each_imu(Observations& seen, const std::function<void(ImuSample&)>& change) {
  std::ranges::for_each(seen.imu, change);
}
inline void for_each_wheel(Observations& seen, const std::function<void(WheelSample&)>& change) {
  std::ranges::for_each(seen.wheels, change);
}
inline void for_each_fix(Observations& seen, const std::function<void(GnssSample&)>& change) {
  std::ranges::for_each(seen.gnss, change);
}

}  // namespace furrow::diagnosis
