#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "furrow_diagnosis/diagnosis.hpp"
#include "furrow_diagnosis/report.hpp"
#include "sound_sensors.hpp"

namespace furrow::diagnosis {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegrees = 180.0 / std::numbers::pi;

/// Keeps one of `n` messages.
void thin(TopicObservation& topic, std::size_t n) {
  std::vector<MessageTimes> kept;
  for (std::size_t i = 0; i < topic.times.size(); i += n) kept.push_back(topic.times[i]);
  topic.times = kept;
  topic.messages = kept.size();
}

struct Fault {
  std::string check;  ///< must be found first
  std::size_t input;
  std::string named;  ///< must be in its problem or remedy
  std::function<void(Observations&)> seed;
};

std::vector<Fault> delivery_faults() {
  return {
      {"topic.no_writer", kImage, "remap it to 'camera/color/image_raw'",
       [](Observations& s) {
         s.topics[kImage] = {.topic = "camera/image",
                             .role = Role::kImage,
                             .type = "sensor_msgs/msg/Image",
                             .readers = "perception",
                             .required = true,
                             .alternatives = {"camera/color/image_raw"}};
         s.image.reset();
       }},
      {"topic.no_writer", kGnss, "has no prefix rt/",
       [](Observations& s) {
         s.topics[kGnss].writers.clear();
         s.topics[kGnss].times.clear();
         s.topics[kGnss].messages = 0;
         s.topics[kGnss].alternatives = {"//gnss/fix"};
         s.gnss.clear();
       }},
      {"topic.type", kImage, "sensor_msgs/msg/CompressedImage instead of sensor_msgs/msg/Image",
       [](Observations& s) {
         s.topics[kImage].writers[0].type = "sensor_msgs/msg/CompressedImage";
         s.topics[kImage].times.clear();
         s.topics[kImage].messages = 0;
         s.image.reset();
       }},
      {"topic.qos", kWheels, "offered volatile, requested transient local",
       [](Observations& s) {
         s.topics[kWheels].writers[0].incompatibility =
             "durability: offered volatile, requested transient local";
         s.topics[kWheels].times.clear();
         s.topics[kWheels].messages = 0;
         s.wheels.clear();
       }},
      {"topic.silent", kDepth, "no message arrived",
       [](Observations& s) {
         s.topics[kDepth].times.clear();
         s.topics[kDepth].messages = 0;
         s.depth.reset();
       }},
      {"topic.two_writers", kWheels, "'driver', 'simulator'",
       [](Observations& s) {
         s.topics[kWheels].writers.push_back({"simulator", "nav_msgs/msg/Odometry", ""});
       }},
      {"topic.malformed", kImu, "7 of 500", [](Observations& s) { s.topics[kImu].malformed = 7; }},
  };
}

std::vector<Fault> clock_faults() {
  return {
      {"stamp.zero", kImu, "500 of 500",
       [](Observations& s) {
         for (MessageTimes& times : s.topics[kImu].times) times.stamp = Time();
       }},
      {"stamp.other_clock", kImage, "1970",
       [](Observations& s) { shift_stamps(s.topics[kImage], 100.0 - kStart.to_seconds()); }},
      {"stamp.future", kDepth, "0.290 s ahead",
       [](Observations& s) { shift_stamps(s.topics[kDepth], 0.3); }},
      {"stamp.late", kWheels, "0.310 s older",
       [](Observations& s) { shift_stamps(s.topics[kWheels], -0.3); }},
      {"stamp.host_clock", kGnss, "1.999 s ahead of",
       [](Observations& s) {
         for (MessageTimes& times : s.topics[kGnss].times) {
           times.stamp += Duration::seconds(2.0);
           times.sent += Duration::seconds(2.0);
         }
       }},
      {"stamp.host_clock", kGnss, "2.001 s behind",
       [](Observations& s) {
         for (MessageTimes& times : s.topics[kGnss].times) {
           times.stamp += Duration::seconds(-2.0);
           times.sent += Duration::seconds(-2.0);
         }
       }},
      {"stamp.order", kImu, "1 of 500",
       [](Observations& s) { s.topics[kImu].times[9].stamp = s.topics[kImu].times[8].stamp; }},
  };
}

std::vector<Fault> camera_faults() {
  return {
      {"image.encoding", kImage, "yuv420",
       [](Observations& s) { s.image->problem = "image encoding 'yuv420' is not one of bgr8"; }},
      {"image.grey", kImage, "mono8",
       [](Observations& s) {
         s.image->encoding = "mono8";
         s.image->grey = true;
       }},
      {"image.uniform", kImage, "lens cap", [](Observations& s) { s.image->uniform = true; }},
      {"image.size", kImage, "640 x 480 px, camera_info says 1280 x 960 px",
       [](Observations& s) {
         s.image->width_px = 640;
         s.image->height_px = 480;
         s.depth->width_px = 640;
         s.depth->height_px = 480;
       }},
      {"camera_info.uncalibrated", kInfo, "not calibrated",
       [](Observations& s) { s.calibration->intrinsics.fx_px = 0.0; }},
      {"camera_info.focal_length", kInfo, "fx is 8.7 px",
       [](Observations& s) { s.calibration->intrinsics.fx_px = 8.7; }},
      {"camera_info.focal_length", kInfo, "fx is - px",
       [](Observations& s) { s.calibration->intrinsics.fx_px = kNan; }},
      {"camera_info.aspect", kInfo, "fy 435.0",
       [](Observations& s) { s.calibration->intrinsics.fy_px = 435.0; }},
      {"camera_info.centre", kInfo, "(0.0, 479.5)",
       [](Observations& s) { s.calibration->intrinsics.cx_px = 0.0; }},
      {"camera_info.distortion", kInfo, "ftheta",
       [](Observations& s) { s.calibration->problem = "distortion model 'ftheta' is not known"; }},
      {"camera_info.urdf", kInfo, "fx 1000.0 px, the URDF 1280 x 960 px with fx 870.0 px",
       [](Observations& s) {
         s.calibration->intrinsics.fx_px = s.calibration->intrinsics.fy_px = 1000.0;
       }},
      {"frame.urdf", kImage, "'zed_left', the camera of the URDF is link 'camera_optical'",
       [](Observations& s) {
         for (const std::size_t i : {kImage, kInfo, kDepth}) s.topics[i].frame = "zed_left";
       }},
      {"frame.camera_info", kInfo, "'left'",
       [](Observations& s) { s.topics[kInfo].frame = "left"; }},
  };
}

std::vector<Fault> depth_faults() {
  return {
      {"depth.encoding", kDepth, "rgb8",
       [](Observations& s) { s.depth->problem = "image encoding 'rgb8' is not a depth image"; }},
      {"depth.size", kDepth, "640 x 480",
       [](Observations& s) {
         s.depth->width_px = 640;
         s.depth->height_px = 480;
       }},
      {"depth.distance", kDepth, "9.800 m, the URDF's camera is 1.000 m",
       [](Observations& s) { s.depth->median_m = 9.8; }},
      {"depth.distance", kDepth, "publish metres",
       [](Observations& s) {
         s.depth->encoding = "32FC1";
         s.depth->median_m = 980.0;
       }},
      {"depth.empty", kDepth, "no pixel", [](Observations& s) { s.depth->median_m.reset(); }},
      {"depth.pairing", kDepth, "50 ms",
       [](Observations& s) { shift_stamps(s.topics[kDepth], -0.05); }},
      {"frame.depth", kDepth, "not registered",
       [](Observations& s) { s.topics[kDepth].frame = "depth_optical"; }},
  };
}

std::vector<Fault> imu_faults() {
  const auto turn = [](double factor) {
    return [factor](Observations& s) {
      for_each_imu(s, [&](ImuSample& i) { i.rate_radps *= factor; });
    };
  };
  const auto acceleration = [](const Eigen::Vector3d& value) {
    return [value](Observations& s) {
      for_each_imu(s, [&](ImuSample& i) { i.acceleration_mps2 = value; });
    };
  };
  return {
      {"imu.not_finite", kImu, "1 of 500", [](Observations& s) { s.imu[3].rate_radps.z() = kNan; }},
      {"imu.no_rate", kImu, "-1",
       [](Observations& s) { for_each_imu(s, [](ImuSample& i) { i.rate_unknown = true; }); }},
      {"imu.rate_unit", kImu, "57.", turn(kDegrees)},
      {"imu.rate_scale", kImu, "2.00 times", turn(2.0)},
      {"imu.turn_sign", kImu, "against the wheels", turn(-1.0)},
      {"imu.axis", kImu, "does not follow",
       [](Observations& s) {
         for_each_imu(s, [](ImuSample& i) { i.rate_radps = {i.rate_radps.z(), 0.0, 0.001}; });
       }},
      {"imu.rate_unit", kImu, "no field robot",
       [](Observations& s) {
         for_each_wheel(s, [](WheelSample& w) { w.yaw_rate_radps = 0.0; });
         s.imu[40].rate_radps.z() = 17.0;
       }},
      {"imu.gravity_axis", kImu, "(0.00, 9.81, 0.00)", acceleration({0.0, 9.81, 0.0})},
      {"imu.gravity_axis", kImu, "-9.81", acceleration({0.0, 0.0, -9.81})},
      {"imu.acceleration_unit", kImu, "in g", acceleration({0.0, 0.0, 1.0})},
      {"imu.frame", kImu, "empty", [](Observations& s) { s.topics[kImu].frame.clear(); }},
  };
}

std::vector<Fault> wheel_faults() {
  const auto speed = [](double factor) {
    return [factor](Observations& s) {
      for_each_wheel(s, [&](WheelSample& w) { w.speed_mps *= factor; });
    };
  };
  return {
      {"wheels.not_finite", kWheels, "1 of 250",
       [](Observations& s) { s.wheels[3].position_m.x() = kNan; }},
      {"wheels.coordinates", kWheels, "(364000, 5609000)",
       [](Observations& s) {
         for_each_wheel(s, [](WheelSample& w) { w.position_m += Eigen::Vector2d(364e3, 5609e3); });
       }},
      {"wheels.speed_unit", kWheels, "km/h", speed(3.6)},
      {"wheels.speed_unit", kWheels, "mm/s", speed(1000.0)},
      {"wheels.speed_sign", kWheels, "positive is forward", speed(-1.0)},
      {"wheels.speed_scale", kWheels, "wheel radius", speed(2.0)},
      {"wheels.no_twist", kWheels, "the twist is zero", speed(0.0)},
      {"wheels.speed_unit", kWheels, "18.0 m/s",
       [](Observations& s) {
         s.gnss.clear();
         for_each_wheel(s, [](WheelSample& w) {
           w.position_m.setZero();
           w.speed_mps = 18.0;
         });
       }},
      {"wheels.speed_unit", kWheels, "the GNSS 2.40 m: the speed is in mm/s",
       [](Observations& s) {
         for_each_wheel(s, [](WheelSample& w) {
           w.position_m *= 1000.0;
           w.speed_mps *= 1000.0;
         });
       }},
      {"wheels.against_gnss", kWheels, "the wheels say 4.80 m, the GNSS 2.40 m",
       [](Observations& s) {
         for_each_wheel(s, [](WheelSample& w) {
           w.position_m *= 2.0;
           w.speed_mps *= 2.0;
         });
       }},
      {"wheels.against_gnss", kWheels, "the GNSS 0.00 m",
       [](Observations& s) { for_each_fix(s, [](GnssSample& fix) {
                               fix.p_FA_m = {3.0, 1.0};
                             }); }},
      {"wheels.yaw_rate_unit", kWheels, "deg/s",
       [](Observations& s) {
         for_each_wheel(s, [](WheelSample& w) { w.yaw_rate_radps *= kDegrees; });
       }},
      {"wheels.child_frame", kWheels, "'odom_child'",
       [](Observations& s) { s.wheels_child_frame = "odom_child"; }},
  };
}

std::vector<Fault> gnss_faults() {
  return {
      {"gnss.no_fix", kGnss, "25 of 25 fixes",
       [](Observations& s) {
         for_each_fix(s, [](GnssSample& fix) {
           fix.status = -1;
           fix.latitude_deg = kNan;
         });
       }},
      {"gnss.not_finite", kGnss, "1 of 25", [](Observations& s) { s.gnss[2].altitude_m = kNan; }},
      {"gnss.zero", kGnss, "(0, 0)",
       [](Observations& s) {
         for_each_fix(s, [](GnssSample& fix) { fix.latitude_deg = fix.longitude_deg = 0.0; });
       }},
      {"gnss.covariance", kGnss, "zero",
       [](Observations& s) {
         for_each_fix(s, [](GnssSample& fix) { fix.covariance_m2.setZero(); });
       }},
      {"gnss.origin", kGnss, "512.0 km",
       [](Observations& s) { for_each_fix(s, [](GnssSample& fix) { fix.p_FA_m.x() += 512e3; }); }},
      {"gnss.accuracy", kGnss, "2.00 m",
       [](Observations& s) {
         for_each_fix(s, [](GnssSample& fix) {
           fix.status = 0;
           fix.covariance_m2 = 4.0 * Eigen::Matrix2d::Identity();
         });
       }},
  };
}

std::vector<Fault> rate_faults() {
  return {
      {"rate.low", kWheels, "5.00 Hz", [](Observations& s) { thin(s.topics[kWheels], 10); }},
      {"rate.low", kGnss, "0.20 Hz",
       [](Observations& s) {
         s.topics[kGnss].times.resize(1);
         s.topics[kGnss].messages = 1;
       }},
      {"rate.lost", kImu, "10 %",
       [](Observations& s) {
         auto& times = s.topics[kImu].times;
         std::size_t i = 0;
         std::erase_if(times, [&](const MessageTimes&) { return i++ % 10 == 5; });
       }},
      {"rate.bursts", kWheels, "longer than",
       [](Observations& s) {
         // Ten messages arrive together, with the last of them.
         auto& times = s.topics[kWheels].times;
         for (std::size_t i = 0; i < times.size(); ++i) {
           times[i].arrival = times[i / 10 * 10 + 9].arrival;
           times[i].sent = times[i].arrival;
         }
       }},
  };
}

class SeededFault : public ::testing::TestWithParam<Fault> {};

TEST_P(SeededFault, IsNamedFirst) {
  const Fault& fault = GetParam();
  Observations seen = sound_sensors();
  fault.seed(seen);
  const Diagnosis diagnosis = diagnose(seen, sound_expectation());
  ASSERT_FALSE(diagnosis.findings.empty());
  const Finding& first = diagnosis.findings.front();
  EXPECT_EQ(first.check, fault.check) << report_text(seen, diagnosis);
  EXPECT_EQ(first.topic, seen.topics[fault.input].topic);
  EXPECT_NE((first.problem + "; " + first.remedy).find(fault.named), std::string::npos)
      << first.problem << "; " << first.remedy;
  EXPECT_FALSE(first.remedy.empty());
}

INSTANTIATE_TEST_SUITE_P(Delivery, SeededFault, ::testing::ValuesIn(delivery_faults()));
INSTANTIATE_TEST_SUITE_P(Clock, SeededFault, ::testing::ValuesIn(clock_faults()));
INSTANTIATE_TEST_SUITE_P(Camera, SeededFault, ::testing::ValuesIn(camera_faults()));
INSTANTIATE_TEST_SUITE_P(Depth, SeededFault, ::testing::ValuesIn(depth_faults()));
INSTANTIATE_TEST_SUITE_P(Imu, SeededFault, ::testing::ValuesIn(imu_faults()));
INSTANTIATE_TEST_SUITE_P(Wheels, SeededFault, ::testing::ValuesIn(wheel_faults()));
INSTANTIATE_TEST_SUITE_P(Gnss, SeededFault, ::testing::ValuesIn(gnss_faults()));
INSTANTIATE_TEST_SUITE_P(Rate, SeededFault, ::testing::ValuesIn(rate_faults()));

}  // namespace
}  // namespace furrow::diagnosis
