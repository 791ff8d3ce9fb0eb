// doctor_peer DOMAIN FAULT: publishes the sensors of a robot, with one fault or with "none", until
// its standard input ends.
#include <poll.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <memory>
#include <set>
#include <string>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_msgs/topics.hpp"
#include "sensor_messages.hpp"

namespace furrow::diagnosis {
namespace {

namespace topics = msgs::topics;

Time now() {
  const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
  return Time::from_nanoseconds(
      std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count());
}

class Drivers {
 public:
  Drivers(dds::DdsTransport& transport, std::string fault)
      : fault_(std::move(fault)),
        messages_(now()),
        info_(writer<topics::CameraInfo>(transport)),
        depth_(writer<topics::CameraDepth>(transport)),
        wheels_(writer<topics::WheelOdometry>(transport)),
        imu_(writer<topics::Imu>(transport)),
        fix_(writer<topics::GnssFix>(transport)) {
    if (is("two_writers")) second_ = writer<topics::WheelOdometry>(transport);
    if (is("type")) {
      other_ = transport.make_raw_writer("camera/image", "sensor_msgs::msg::dds_::CompressedImage_",
                                         topics::CameraImage::topic().qos);
    } else {
      const auto& topic = topics::CameraImage::topic();
      image_ = transport.make_writer(is("name") ? "camera/color/image_raw" : "camera/image",
                                     *topic.type, topic.qos);
    }
  }

  static bool knows(const std::string& fault) {
    static const std::set<std::string> faults = {
        "none",   "name", "type",     "silent", "two_writers", "future",      "epoch",   "encoding",
        "no_fix", "utm",  "km_per_h", "size",   "depth_unit",  "imu_degrees", "imu_sign"};
    return faults.contains(fault);
  }

  /// A hundred times a second.
  void tick(Time stamp) {
    constexpr int kImage = 33;
    constexpr int kFix = 20;
    put(*imu_, imu(stamp));
    if (ticks_ % 2 == 0) put(*wheels_, wheels(stamp));
    if (ticks_ % kFix == 0) put(*fix_, fix(stamp));
    if (ticks_ % kImage == 0) {
      if (image_) put(*image_, image(stamp));
      put(*info_, messages_.camera_info(stamp));
      if (!is("silent")) put(*depth_, messages_.depth(stamp, is("depth_unit") ? 10'000 : 1000));
    }
    ++ticks_;
  }

 private:
  using Writer = std::unique_ptr<graph::TransportWriter>;

  template <class T>
  static Writer writer(dds::DdsTransport& transport) {
    const msgs::Topic& topic = T::topic();
    return transport.make_writer(std::string(topic.name), *topic.type, topic.qos);
  }
  template <class Message>
  static void put(graph::TransportWriter& writer, Message message) {
    writer.write(std::make_shared<Message>(std::move(message)));
  }
  [[nodiscard]] bool is(const char* fault) const { return fault_ == fault; }

  [[nodiscard]] sensor_msgs::msg::Image image(Time stamp) const {
    sensor_msgs::msg::Image message =
        messages_.image(is("future") ? stamp + Duration::seconds(2.0) : stamp);
    if (is("encoding")) message.encoding("yuv420");
    if (is("size")) message.height(message.height() / 2);
    return message;
  }
  [[nodiscard]] nav_msgs::msg::Odometry wheels(Time stamp) const {
    nav_msgs::msg::Odometry message = messages_.wheels(stamp);
    auto& position = message.pose().pose().position();
    if (is("utm")) position.x(position.x() + 364e3);
    auto& linear = message.twist().twist().linear();
    if (is("km_per_h")) linear.x(3.6 * linear.x());
    return message;
  }
  [[nodiscard]] sensor_msgs::msg::Imu imu(Time stamp) const {
    // A clock since boot.
    sensor_msgs::msg::Imu message =
        messages_.imu(is("epoch") ? Time::from_seconds(100.0 + 0.01 * ticks_) : stamp);
    auto& rate = message.angular_velocity();
    if (is("imu_degrees")) rate.z(rate.z() * 180.0 / M_PI);
    if (is("imu_sign")) rate.z(-rate.z());
    return message;
  }
  [[nodiscard]] sensor_msgs::msg::NavSatFix fix(Time stamp) const {
    sensor_msgs::msg::NavSatFix message = messages_.fix(stamp);
    if (is("no_fix")) message.status().status(255);  // -1
    return message;
  }

  std::string fault_;
  SensorMessages messages_;
  int ticks_ = 0;
  Writer image_;
  Writer info_;
  Writer depth_;
  Writer wheels_;
  Writer imu_;
  Writer fix_;
  Writer second_;
  std::unique_ptr<dds::RawWriter> other_;
};

int play(std::int64_t domain, const std::string& fault) {
  dds::DdsParameters parameters;
  parameters.domain_id = domain;
  parameters.process_name = "drivers";
  dds::DdsTransport transport(parameters);
  Drivers drivers(transport, fault);
  constexpr Duration kPeriod = Duration::milliseconds(10);
  pollfd input = {STDIN_FILENO, POLLIN, 0};
  int timeout_ms = 0;
  // Stamps are those of the plan, as sensors have them, however late this process runs.
  for (Time next = now(); poll(&input, 1, timeout_ms) == 0; next += kPeriod) {
    drivers.tick(next);
    const double left_s = (next + kPeriod - now()).to_seconds();
    timeout_ms = left_s > 0.0 ? static_cast<int>(std::ceil(1e3 * left_s)) : 0;
  }
  return 0;
}

}  // namespace
}  // namespace furrow::diagnosis

int main(int argc, char** argv) {
  if (argc != 3 || !furrow::diagnosis::Drivers::knows(argv[2])) {
    std::cerr << "doctor_peer DOMAIN FAULT\n";
    return 2;
  }
  return furrow::diagnosis::play(std::strtol(argv[1], nullptr, 10), argv[2]);
}
