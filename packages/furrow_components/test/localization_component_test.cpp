// Where localization starts, in simulated time.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "feeder.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_components/georeference.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

/// Wheels that start at a pose and drive straight on, and the poses that come of it.
struct Drive {
  geometry::Pose2 start;
  std::vector<BaseOdometry> poses;
};

class Wheels final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.input<topics::RobotOdometry>().output<topics::WheelOdometry>();
  }

  Wheels(graph::Context& context, Drive& drive) {
    auto out = context.output<topics::WheelOdometry>();
    context.every(Duration::milliseconds(20), [&context, &drive, out](Time now) {
      geometry::Pose2 pose = drive.start;
      pose.x_m += 0.5 * now.to_seconds();
      out.publish(to_msg(BaseOdometry{now, pose, 0.5, 0.0}, "odom"));
      if (now.to_seconds() >= 1.0) context.request_stop("finished");
    });
    context.input<topics::RobotOdometry>(
        [&drive](const auto& message) { drive.poses.push_back(from_msg(*message)); });
  }
};

std::string run(Drive& drive, const std::string& start) {
  graph::Registry registry;
  registry.load_library(FURROW_LOCALIZATION_LIBRARY);
  registry.add(feeder_class<Wheels>(drive));
  graph::GraphSpec spec;
  spec.components = {{.name = "localization",
                      .group = "localization",
                      .class_name = "localization",
                      .parameters = {{"start", start, {}}}},
                     {.name = "feeder", .group = "feeder", .class_name = "feeder"}};
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  return runtime.run().reason;
}

TEST(LocalizationComponent, StartsWhereTheWheelsSay) {
  Drive drive{.start = {3.0, -1.0, 0.0}, .poses = {}};
  EXPECT_EQ(run(drive, "wheels"), "finished");
  ASSERT_FALSE(drive.poses.empty());
  EXPECT_NEAR(drive.poses.front().X_FB.y_m, -1.0, 1e-9);
  EXPECT_NEAR(drive.poses.back().X_FB.x_m, 3.5, 0.02);
}

TEST(LocalizationComponent, RefusesWheelsInAMapFrameAndNamesTheWayOut) {
  Drive drive{.start = {300'000.0, 5'600'000.0, 0.0}, .poses = {}};
  const std::string reason = run(drive, "wheels");
  EXPECT_TRUE(drive.poses.empty());
  EXPECT_NE(reason.find("x 300000.0 m, y 5600000.0 m"), std::string::npos) << reason;
  EXPECT_NE(reason.find("localization.start=parameters"), std::string::npos) << reason;
}

TEST(LocalizationComponent, WheelsInAMapFrameWorkFromTheInitialPose) {
  Drive drive{.start = {300'000.0, 5'600'000.0, 0.0}, .poses = {}};
  EXPECT_EQ(run(drive, "parameters"), "finished");
  ASSERT_FALSE(drive.poses.empty());
  EXPECT_NEAR(drive.poses.back().X_FB.x_m, 0.5, 0.02);
  EXPECT_NEAR(drive.poses.back().X_FB.y_m, 0.0, 1e-9);
}

/// Wheels, and a GNSS receiver with the same fix again and again.
class WheelsAndGnss final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.input<topics::RobotOdometry>().output<topics::WheelOdometry>().output<topics::GnssFix>();
  }

  WheelsAndGnss(graph::Context& context, const sensor_msgs::msg::NavSatFix& fix) {
    auto wheels = context.output<topics::WheelOdometry>();
    auto gnss = context.output<topics::GnssFix>();
    context.every(Duration::milliseconds(20), [&context, &fix, wheels, gnss](Time now) {
      wheels.publish(to_msg(BaseOdometry{now, {}, 0.0, 0.0}, "odom"));
      sensor_msgs::msg::NavSatFix stamped = fix;
      stamped.header(header(now, "gnss_antenna"));
      gnss.publish(std::move(stamped));
      if (now.to_seconds() >= 2.0) context.request_stop("finished");
    });
    context.input<topics::RobotOdometry>([](const auto&) {});
  }
};

graph::Health health_with(const sensor_msgs::msg::NavSatFix& fix) {
  graph::Registry registry;
  registry.load_library(FURROW_LOCALIZATION_LIBRARY);
  registry.add(feeder_class<WheelsAndGnss>(fix));
  graph::GraphSpec spec;
  spec.components = {{.name = "localization",
                      .group = "localization",
                      .class_name = "localization",
                      .parameters = {{"estimator", std::string("filter"), {}}}},
                     {.name = "feeder", .group = "feeder", .class_name = "feeder"}};
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  EXPECT_EQ(runtime.run().reason, "finished");
  return runtime.status().front().health;
}

/// At the origin of the field by default.
sensor_msgs::msg::NavSatFix fix_at(double latitude_deg, std::uint8_t status) {
  const GeoreferenceParameters origin;
  sensor_msgs::msg::NavSatFix fix;
  fix.status().status(status);
  fix.latitude(latitude_deg);
  fix.longitude(origin.origin_longitude_deg);
  fix.altitude(origin.origin_altitude_m);
  fix.position_covariance_type(3);
  for (const std::size_t i : {0U, 4U, 8U}) fix.position_covariance()[i] = 1e-4;
  return fix;
}

TEST(LocalizationComponent, UsesRtkFixes) {
  const auto health = health_with(fix_at(GeoreferenceParameters().origin_latitude_deg, 2));
  EXPECT_EQ(health.level, graph::HealthLevel::kOk) << health.message;
}

TEST(LocalizationComponent, NamesAReceiverWithoutAFixInItsHealth) {
  const auto health = health_with(fix_at(GeoreferenceParameters().origin_latitude_deg, 255));
  EXPECT_NE(health.level, graph::HealthLevel::kOk);
  EXPECT_NE(health.message.find("GNSS: the receiver has no fix"), std::string::npos)
      << health.message;
  EXPECT_GT(health.counters.at("gnss_no_fix"), 50);
}

TEST(LocalizationComponent, DoesNotJumpToFixesOfAnotherPlaceAndNamesTheOrigin) {
  const auto health = health_with(fix_at(GeoreferenceParameters().origin_latitude_deg + 2.0, 2));
  EXPECT_NE(health.message.find("222 km from the origin"), std::string::npos) << health.message;
  EXPECT_FALSE(health.counters.contains("gnss_recovered"));
}

}  // namespace
}  // namespace furrow::components
