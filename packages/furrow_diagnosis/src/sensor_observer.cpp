#include "furrow_diagnosis/sensor_observer.hpp"

#include <algorithm>

#include "furrow_components/camera_calibration.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_components/image_conversions.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/message_types.hpp"
#include "furrow_vision/rectifier.hpp"

namespace furrow::diagnosis {
namespace {

/// Reads the message and notes times and frame; false: it is malformed.
template <class Message>
bool read(TopicObservation& topic, std::span<const std::byte> payload, MessageTimes times,
          Message& message) {
  if (!msgs::message_type<Message>().deserialize(payload, &message).ok()) {
    ++topic.malformed;
    return false;
  }
  topic.frame = message.header().frame_id();
  times.stamp = graph::from_msg(message.header().stamp());
  if (topic.times.size() < SensorObserver::kMaxSamples) topic.times.push_back(times);
  return true;
}

template <class Sample>
void keep(std::vector<Sample>& samples, const Sample& sample) {
  if (samples.size() < SensorObserver::kMaxSamples) samples.push_back(sample);
}

Eigen::Vector3d vector_of(const geometry_msgs::msg::Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

/// Whether a sample of the bytes is equal.
bool uniform(const std::vector<std::uint8_t>& data) {
  constexpr std::size_t kStep = 97;  // a prime: no period of rows and channels
  for (std::size_t i = 0; i < data.size(); i += kStep) {
    if (data[i] != data.front()) return false;
  }
  return !data.empty();
}

}  // namespace

SensorObserver::SensorObserver(const SensorSetup& setup)
    : depth_unit_m_(setup.expectation.depth_unit_m),
      rectified_(setup.rectified),
      georeference_(setup.georeference) {
  for (const SensorInput& sensor : setup.inputs) {
    TopicObservation topic;
    topic.topic = sensor.input.topic;
    topic.role = sensor.role;
    topic.type = sensor.input.ros_type;
    topic.required = sensor.input.required;
    for (const std::string& reader : sensor.input.readers) {
      topic.readers += (topic.readers.empty() ? "" : ", ") + reader;
    }
    seen_.topics.push_back(std::move(topic));
  }
}

void SensorObserver::take(std::size_t input, std::span<const std::byte> payload, Time sent,
                          Time arrival) {
  TopicObservation& topic = seen_.topics.at(input);
  ++topic.messages;
  const MessageTimes times{.stamp = {}, .sent = sent, .arrival = arrival};
  switch (topic.role) {
    case Role::kImage:
      return image(topic, payload, times);
    case Role::kCameraInfo:
      return camera_info(topic, payload, times);
    case Role::kDepth:
      return depth(topic, payload, times);
    case Role::kWheels:
      return wheels(topic, payload, times);
    case Role::kImu:
      return imu(topic, payload, times);
    case Role::kGnss:
      return gnss(topic, payload, times);
    case Role::kOther:
      break;
  }
}

void SensorObserver::image(TopicObservation& topic, std::span<const std::byte> payload,
                           MessageTimes times) {
  sensor_msgs::msg::Image message;
  if (!read(topic, payload, times, message)) return;
  ImageObservation seen{.width_px = static_cast<int>(message.width()),
                        .height_px = static_cast<int>(message.height()),
                        .encoding = message.encoding()};
  const bool known = seen_.image && seen_.image->encoding == seen.encoding &&
                     seen_.image->width_px == seen.width_px &&
                     seen_.image->height_px == seen.height_px;
  if (known) {
    seen_.image->uniform = seen_.image->uniform && uniform(message.data());
    return;
  }
  if (const auto bgr = components::bgr_of(message); !bgr.ok()) seen.problem = bgr.error().message;
  seen.grey = components::is_grey(message);
  seen.uniform = uniform(message.data());
  seen_.image = seen;
}

void SensorObserver::camera_info(TopicObservation& topic, std::span<const std::byte> payload,
                                 MessageTimes times) {
  sensor_msgs::msg::CameraInfo message;
  if (!read(topic, payload, times, message)) return;
  const auto calibration = components::calibration_of(message, rectified_);
  CalibrationObservation seen{.intrinsics = calibration.intrinsics, .problem = {}};
  const bool known = seen_.calibration && topic.messages > 1 &&
                     seen_.calibration->intrinsics.width_px == seen.intrinsics.width_px &&
                     seen_.calibration->intrinsics.fx_px == seen.intrinsics.fx_px;
  if (known) return;
  // The checks of the intrinsics name their faults better.
  constexpr int kMaxSide_px = 1 << 15;
  const auto& k = calibration.intrinsics;
  if (k.fx_px > 0.0 && k.fy_px > 0.0 && k.width_px > 0 && k.height_px > 0 &&
      std::max(k.width_px, k.height_px) < kMaxSide_px) {
    const auto rectifier = vision::Rectifier::make(k, calibration.distortion);
    if (!rectifier.ok()) seen.problem = rectifier.error().message;
  }
  seen_.calibration = seen;
}

void SensorObserver::depth(TopicObservation& topic, std::span<const std::byte> payload,
                           MessageTimes times) {
  sensor_msgs::msg::Image message;
  if (!read(topic, payload, times, message)) return;
  constexpr std::uint64_t kEach = 5;  // the ground does not change that fast
  if (seen_.depth && topic.messages % kEach != 1) return;
  DepthObservation seen{.width_px = static_cast<int>(message.width()),
                        .height_px = static_cast<int>(message.height()),
                        .encoding = message.encoding()};
  const auto depth_m = components::depth_m_of(message, depth_unit_m_);
  if (depth_m.ok()) {
    seen.median_m = components::median_depth_m(*depth_m);
  } else {
    seen.problem = depth_m.error().message;
  }
  seen_.depth = seen;
}

void SensorObserver::wheels(TopicObservation& topic, std::span<const std::byte> payload,
                            MessageTimes times) {
  nav_msgs::msg::Odometry message;
  if (!read(topic, payload, times, message)) return;
  const components::BaseOdometry base = components::from_msg(message);
  seen_.wheels_child_frame = message.child_frame_id();
  keep(seen_.wheels, WheelSample{.stamp = base.stamp,
                                 .arrival = times.arrival,
                                 .position_m = {base.X_FB.x_m, base.X_FB.y_m},
                                 .yaw_rad = base.X_FB.heading_rad,
                                 .speed_mps = base.speed_mps,
                                 .yaw_rate_radps = base.yaw_rate_radps});
}

void SensorObserver::imu(TopicObservation& topic, std::span<const std::byte> payload,
                         MessageTimes times) {
  sensor_msgs::msg::Imu message;
  if (!read(topic, payload, times, message)) return;
  keep(seen_.imu, ImuSample{.arrival = times.arrival,
                            .rate_radps = vector_of(message.angular_velocity()),
                            .acceleration_mps2 = vector_of(message.linear_acceleration()),
                            .rate_unknown = message.angular_velocity_covariance()[0] == -1.0});
}

void SensorObserver::gnss(TopicObservation& topic, std::span<const std::byte> payload,
                          MessageTimes times) {
  sensor_msgs::msg::NavSatFix message;
  if (!read(topic, payload, times, message)) return;
  const auto& c = message.position_covariance();
  GnssSample fix{.arrival = times.arrival,
                 .latitude_deg = message.latitude(),
                 .longitude_deg = message.longitude(),
                 .altitude_m = message.altitude(),
                 .status = static_cast<std::int8_t>(message.status().status()),
                 .covariance_known = static_cast<int>(message.position_covariance_type()) != 0};
  fix.covariance_m2 << c[0], c[1], c[3], c[4];
  fix.p_FA_m = georeference_.from_msg(message).p_FA_m;
  keep(seen_.gnss, fix);
}

}  // namespace furrow::diagnosis
