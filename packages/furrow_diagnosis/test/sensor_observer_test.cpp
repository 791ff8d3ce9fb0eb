#include "furrow_diagnosis/sensor_observer.hpp"

#include <gtest/gtest.h>

#include "furrow_diagnosis/diagnosis.hpp"
#include "furrow_diagnosis/report.hpp"
#include "furrow_msgs/message_types.hpp"
#include "sensor_messages.hpp"
#include "sound_sensors.hpp"

namespace furrow::diagnosis {
namespace {

enum Place : std::size_t { kImageAt, kInfoAt, kDepthAt, kWheelsAt, kImuAt, kFixAt };

SensorSetup setup_of_robot() {
  SensorSetup setup;
  setup.expectation = sound_expectation();
  const std::tuple<const char*, Role, const char*> inputs[] = {
      {"camera/image", Role::kImage, "sensor_msgs/msg/Image"},
      {"camera/camera_info", Role::kCameraInfo, "sensor_msgs/msg/CameraInfo"},
      {"camera/depth", Role::kDepth, "sensor_msgs/msg/Image"},
      {"wheel/odometry", Role::kWheels, "nav_msgs/msg/Odometry"},
      {"imu/data", Role::kImu, "sensor_msgs/msg/Imu"},
      {"gnss/fix", Role::kGnss, "sensor_msgs/msg/NavSatFix"}};
  for (const auto& [topic, role, type] : inputs) {
    SensorInput sensor;
    sensor.input.topic = topic;
    sensor.input.ros_type = type;
    sensor.input.readers = {"perception", "tracker"};
    sensor.role = role;
    setup.inputs.push_back(sensor);
  }
  return setup;
}

template <class Message>
std::vector<std::byte> bytes_of(const Message& message) {
  const auto& type = msgs::message_type<Message>();
  std::vector<std::byte> bytes(type.serialized_size(&message));
  const auto size = type.serialize(&message, bytes);
  EXPECT_TRUE(size.ok());
  bytes.resize(*size);
  return bytes;
}

/// Messages arrive 5 ms after their stamps.
class ObserverTest : public ::testing::Test {
 protected:
  template <class Message>
  void take(std::size_t input, const Message& message, Time stamp) {
    const Time arrival = stamp + Duration::milliseconds(5);
    observer_.take(input, bytes_of(message), arrival, arrival);
  }
  /// Two seconds of a sound robot.
  void drive() {
    for (int i = 0; i < 200; ++i) {
      const Time stamp = kStart + Duration::milliseconds(10 * i);
      take(kImuAt, messages_.imu(stamp), stamp);
      if (i % 2 == 0) take(kWheelsAt, messages_.wheels(stamp), stamp);
      if (i % 20 == 0) take(kFixAt, messages_.fix(stamp), stamp);
      if (i % 33 != 0) continue;
      take(kImageAt, messages_.image(stamp), stamp);
      take(kInfoAt, messages_.camera_info(stamp), stamp);
      take(kDepthAt, messages_.depth(stamp), stamp);
    }
  }
  /// The checks of what was observed, with a writer for each topic.
  [[nodiscard]] std::vector<std::string> checks() const {
    Observations seen = observer_.observations();
    seen.seconds = 2.0;
    for (TopicObservation& topic : seen.topics) topic.writers = {{"driver", topic.type, ""}};
    std::vector<std::string> names;
    for (const Finding& finding : diagnose(seen, setup_.expectation).findings) {
      names.push_back(finding.check);
    }
    return names;
  }

  SensorSetup setup_ = setup_of_robot();
  SensorObserver observer_{setup_};
  SensorMessages messages_{kStart};
};

using Checks = std::vector<std::string>;

TEST_F(ObserverTest, FindsNothingInTheMessagesOfASoundRobot) {
  drive();
  EXPECT_EQ(checks(), Checks{});
  const Observations& seen = observer_.observations();
  EXPECT_EQ(seen.topics[kImuAt].messages, 200U);
  EXPECT_EQ(seen.topics[kImageAt].frame, "camera_optical");
  EXPECT_EQ(seen.topics[kImageAt].readers, "perception, tracker");
  EXPECT_NEAR(seen.depth->median_m.value(), 1.0, 1e-6);
  EXPECT_NEAR(seen.gnss.front().p_FA_m.norm(), 0.0, 1e-3);
}

TEST_F(ObserverTest, CountsWhatIsNoMessage) {
  drive();
  for (std::size_t input = kImageAt; input <= kFixAt; ++input) {
    observer_.take(input, std::vector<std::byte>(7, std::byte{0xff}), kStart, kStart);
    EXPECT_EQ(observer_.observations().topics[input].malformed, 1U) << input;
  }
  EXPECT_EQ(checks(), Checks(6, "topic.malformed"));
}

TEST_F(ObserverTest, NamesAnEncodingThatPerceptionCannotUse) {
  drive();
  auto image = messages_.image(kStart + Duration::seconds(2.0));
  image.encoding("yuv420");
  take(kImageAt, image, kStart + Duration::seconds(2.0));
  EXPECT_EQ(checks(), Checks{"image.encoding"});
  EXPECT_NE(observer_.observations().image->problem.find("yuv420"), std::string::npos);
}

TEST_F(ObserverTest, TellsGreyAndUniformImages) {
  auto image = messages_.image(kStart);
  image.encoding("mono8");
  image.step(1280);
  take(kImageAt, image, kStart);
  EXPECT_TRUE(observer_.observations().image->grey);
  EXPECT_FALSE(observer_.observations().image->uniform);
  std::ranges::fill(image.data(), std::uint8_t{0});
  image.width(640);
  take(kImageAt, image, kStart);
  EXPECT_TRUE(observer_.observations().image->uniform);
}

TEST_F(ObserverTest, NamesADistortionModelThatIsNotSupported) {
  drive();
  auto info = messages_.camera_info(kStart + Duration::seconds(2.0));
  info.distortion_model("ftheta");
  info.d({0.1, 0.0, 0.0, 0.0});
  info.k()[0] = 871.0;
  info.k()[4] = 871.0;
  take(kInfoAt, info, kStart + Duration::seconds(2.0));
  EXPECT_EQ(checks(), Checks{"camera_info.distortion"});
}

TEST_F(ObserverTest, ReadsDepthWithTheUnitOfTheGraph) {
  setup_.expectation.depth_unit_m = 1e-4;
  observer_ = SensorObserver(setup_);
  drive();  // in millimetres
  EXPECT_NEAR(observer_.observations().depth->median_m.value(), 0.1, 1e-6);
  EXPECT_EQ(checks(), Checks{"depth.distance"});
}

TEST_F(ObserverTest, ReadsTheSignOfTheStatusAndAnUnknownRate) {
  auto fix = messages_.fix(kStart);
  fix.status().status(255);
  take(kFixAt, fix, kStart);
  EXPECT_EQ(observer_.observations().gnss.front().status, -1);
  auto imu = messages_.imu(kStart);
  imu.angular_velocity_covariance()[0] = -1.0;
  take(kImuAt, imu, kStart);
  EXPECT_TRUE(observer_.observations().imu.front().rate_unknown);
}

TEST_F(ObserverTest, IsBounded) {
  const auto imu = bytes_of(messages_.imu(kStart));
  for (std::size_t i = 0; i < SensorObserver::kMaxSamples + 10; ++i) {
    observer_.take(kImuAt, imu, kStart, kStart);
  }
  const Observations& seen = observer_.observations();
  EXPECT_EQ(seen.imu.size(), SensorObserver::kMaxSamples);
  EXPECT_EQ(seen.topics[kImuAt].times.size(), SensorObserver::kMaxSamples);
  EXPECT_EQ(seen.topics[kImuAt].messages, SensorObserver::kMaxSamples + 10);
}

}  // namespace
}  // namespace furrow::diagnosis
