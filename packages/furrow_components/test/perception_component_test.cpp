// Perception with cameras that differ from the simulated one, in simulated time: what they send is
// used, or the health says why it is not.

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "feeder.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_components/image_conversions.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;
using sensor_msgs::msg::Image;

constexpr int kImages = 10;
const geometry::CameraIntrinsics kIntrinsics{.width_px = 320,
                                             .height_px = 240,
                                             .fx_px = 300.0,
                                             .fy_px = 300.0,
                                             .cx_px = 159.5,
                                             .cy_px = 119.5};
const cv::Point2d kPlant_px(200.0, 90.0);
constexpr double kRadius_px = 20.0;

/// A camera that looks down at one green disc, and what came of its images.
struct World {
  std::map<std::string, ParameterValue> parameters = {{"detector", std::string("index")}};
  /// Called for each message with the number of the image; false: it is not sent.
  std::function<bool(Image&, int)> colour = [](Image&, int) { return true; };
  std::function<bool(Image&, int)> depth = [](Image&, int) { return true; };
  std::function<void(sensor_msgs::msg::CameraInfo&, int)> info = [](auto&, int) {};
  std::vector<furrow_msgs::msg::PlantInstances> seen;
  graph::Health last;

  [[nodiscard]] std::int64_t counter(const std::string& name) const {
    const auto found = last.counters.find(name);
    return found == last.counters.end() ? 0 : found->second;
  }
};

cv::Mat picture() {
  cv::Mat bgr(kIntrinsics.height_px, kIntrinsics.width_px, CV_8UC3, cv::Scalar(60, 80, 110));
  cv::circle(bgr, kPlant_px, static_cast<int>(kRadius_px), cv::Scalar(40, 160, 50), cv::FILLED);
  return bgr;
}

class Feeder final : public graph::Component {
 public:
  Feeder(graph::Context& context, World& world)
      : context_(context),
        world_(world),
        colour_out_(context.output<topics::CameraImage>()),
        depth_out_(context.output<topics::CameraDepth>()),
        info_out_(context.output<topics::CameraInfo>()) {
    context.every(Duration::milliseconds(200), [this](Time now) { show(now); });
    context.input<topics::Instances>(
        [this](const auto& instances) { world_.seen.push_back(*instances); });
  }

  static void describe(graph::Description& d) {
    d.input<topics::Instances>()
        .output<topics::CameraImage>()
        .output<topics::CameraDepth>()
        .output<topics::CameraInfo>();
  }

 private:
  void show(Time now) {
    if (number_ == kImages) {
      context_.request_stop("finished");
      return;
    }
    auto info = to_msg(kIntrinsics, now);
    world_.info(info, number_);
    info_out_.publish(std::move(info));
    Image colour = to_msg(picture(), now, kCameraFrame);
    if (world_.colour(colour, number_)) colour_out_.publish(std::move(colour));
    const cv::Mat ground_m(kIntrinsics.height_px, kIntrinsics.width_px, CV_32FC1, cv::Scalar(1.0));
    Image depth = to_msg(ground_m, now, kCameraFrame);
    if (world_.depth(depth, number_)) depth_out_.publish(std::move(depth));
    ++number_;
  }

  graph::Context& context_;
  World& world_;
  graph::Output<topics::CameraImage> colour_out_;
  graph::Output<topics::CameraDepth> depth_out_;
  graph::Output<topics::CameraInfo> info_out_;
  int number_ = 0;
};

void run(World& world) {
  graph::Registry registry;
  registry.load_library(FURROW_PERCEPTION_LIBRARY);
  registry.add(feeder_class<Feeder>(world));
  graph::GraphSpec spec;
  spec.components = {{.name = "perception", .group = "perception", .class_name = "perception"},
                     {.name = "feeder", .group = "feeder", .class_name = "feeder"}};
  for (const auto& [name, value] : world.parameters) {
    spec.components[0].parameters.push_back({name, value, {}});
  }
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  EXPECT_EQ(runtime.run().reason, "finished");
  for (const auto& status : runtime.status()) {
    if (status.name == "perception") world.last = status.health;
  }
}

void shift_stamp(Image& image, std::int64_t ms) {
  const Time stamp = graph::from_msg(image.header().stamp());
  image.header().stamp(graph::to_msg(stamp + Duration::milliseconds(ms)));
}

void expect_all_seen(const World& world) {
  ASSERT_EQ(world.seen.size(), static_cast<std::size_t>(kImages)) << world.last.message;
  for (const auto& instances : world.seen) {
    ASSERT_EQ(instances.instances().size(), 1U);
    EXPECT_NEAR(instances.instances()[0].stem_u_px(), kPlant_px.x, 1.5);
    EXPECT_NEAR(instances.instances()[0].stem_v_px(), kPlant_px.y, 1.5);
    // The disc at 1 m: 1 px is 1000 / 300 mm.
    const double area_mm2 = 3.1416 * kRadius_px * kRadius_px * (1000.0 / 300.0) * (1000.0 / 300.0);
    EXPECT_NEAR(instances.instances()[0].area_mm2(), area_mm2, 0.06 * area_mm2);
  }
}

TEST(PerceptionComponent, SeesThePlantOfEachImage) {
  World world;
  run(world);
  expect_all_seen(world);
  EXPECT_EQ(world.last.level, graph::HealthLevel::kOk) << world.last.message;
}

TEST(PerceptionComponent, UsesADepthThatWasExposedThreeMillisecondsLater) {
  World world;
  world.depth = [](Image& depth, int) {
    shift_stamp(depth, 3);
    return true;
  };
  run(world);
  expect_all_seen(world);
  EXPECT_EQ(world.last.level, graph::HealthLevel::kOk) << world.last.message;
}

TEST(PerceptionComponent, NamesTheToleranceWhenStampsAreTooFarApart) {
  World world;
  world.depth = [](Image& depth, int) {
    shift_stamp(depth, 45);
    return true;
  };
  run(world);
  EXPECT_TRUE(world.seen.empty());
  EXPECT_EQ(world.last.level, graph::HealthLevel::kError);
  EXPECT_NE(world.last.message.find("depth_tolerance_s"), std::string::npos) << world.last.message;
  EXPECT_GE(world.counter("images_without_depth"), kImages - 1);
}

TEST(PerceptionComponent, SaysThatNoDepthComesAndWhatToDo) {
  World world;
  world.depth = [](Image&, int) { return false; };
  run(world);
  EXPECT_TRUE(world.seen.empty());
  EXPECT_EQ(world.last.level, graph::HealthLevel::kError);
  EXPECT_NE(world.last.message.find("none was heard"), std::string::npos) << world.last.message;
  EXPECT_NE(world.last.message.find("use_depth=false"), std::string::npos) << world.last.message;
}

TEST(PerceptionComponent, TakesTheGroundForImagesWithoutDepthWhenToldTo) {
  World world;
  world.parameters["without_depth"] = std::string("ground");
  world.depth = [](Image&, int number) { return number % 2 == 0; };
  run(world);
  // The last image has no depth, and nothing follows that would end its wait.
  ASSERT_EQ(world.seen.size(), static_cast<std::size_t>(kImages - 1)) << world.last.message;
  EXPECT_EQ(world.counter("images_without_depth"), kImages / 2 - 1);
}

TEST(PerceptionComponent, SaysThatTheDepthContradictsTheMounting) {
  World world;
  world.depth = [](Image& depth, int) {  // in 0.1 mm, as a D405 sends it
    const Time stamp = graph::from_msg(depth.header().stamp());
    depth =
        to_msg(cv::Mat(kIntrinsics.height_px, kIntrinsics.width_px, CV_16UC1, cv::Scalar(10000)),
               stamp, kCameraFrame);
    return true;
  };
  run(world);
  EXPECT_EQ(world.last.level, graph::HealthLevel::kWarn);
  EXPECT_NE(world.last.message.find("10.00 m"), std::string::npos) << world.last.message;
  EXPECT_NE(world.last.message.find("1.00 m"), std::string::npos) << world.last.message;

  world.seen.clear();
  world.parameters["depth_unit_m"] = 1e-4;
  run(world);
  expect_all_seen(world);
  EXPECT_EQ(world.last.level, graph::HealthLevel::kOk) << world.last.message;
}

TEST(PerceptionComponent, ReadsImagesWithAnAlphaChannel) {
  World world;
  world.colour = [](Image& image, int) {
    const Time stamp = graph::from_msg(image.header().stamp());
    cv::Mat bgra;
    cv::cvtColor(picture(), bgra, cv::COLOR_BGR2BGRA);
    image = to_msg(bgra, stamp, kCameraFrame);
    EXPECT_EQ(image.encoding(), "bgra8");
    return true;
  };
  run(world);
  expect_all_seen(world);
}

TEST(PerceptionComponent, RefusesGreyImagesForTheIndex) {
  World world;
  world.colour = [](Image& image, int) {
    const Time stamp = graph::from_msg(image.header().stamp());
    cv::Mat grey;
    cv::cvtColor(picture(), grey, cv::COLOR_BGR2GRAY);
    image = to_msg(grey, stamp, kCameraFrame);
    return true;
  };
  run(world);
  EXPECT_TRUE(world.seen.empty());
  EXPECT_EQ(world.last.level, graph::HealthLevel::kWarn);
  EXPECT_NE(world.last.message.find("grey"), std::string::npos) << world.last.message;
  EXPECT_EQ(world.counter("bad_images"), kImages);
}

TEST(PerceptionComponent, FollowsAChangeOfTheCalibration) {
  World world;
  world.info = [](sensor_msgs::msg::CameraInfo& info, int number) {
    if (number >= kImages / 2) info.k()[0] = info.k()[4] = 600.0;
  };
  run(world);
  ASSERT_EQ(world.seen.size(), static_cast<std::size_t>(kImages));
  const double before_mm2 = world.seen.front().instances().at(0).area_mm2();
  const double after_mm2 = world.seen.back().instances().at(0).area_mm2();
  EXPECT_NEAR(after_mm2, before_mm2 / 4.0, 0.01 * before_mm2);
  EXPECT_EQ(world.counter("calibration_changes"), 1);
}

TEST(PerceptionComponent, NamesADistortionThatItCannotRemove) {
  World world;
  world.info = [](sensor_msgs::msg::CameraInfo& info, int) {
    info.distortion_model("thin_prism");
    info.d(std::vector<double>(12, 0.01));
  };
  run(world);
  EXPECT_TRUE(world.seen.empty());
  EXPECT_EQ(world.last.level, graph::HealthLevel::kError);
  EXPECT_NE(world.last.message.find("thin_prism"), std::string::npos) << world.last.message;
}

TEST(PerceptionComponent, RemovesTheDistortionUnlessTheImagesAreRectified) {
  World world;
  const auto distort = [](sensor_msgs::msg::CameraInfo& info, int) {
    info.d({-0.3, 0.0, 0.0, 0.0, 0.0});
  };
  world.info = distort;
  run(world);
  // The disc as the lens showed it stands nearer the centre than a pinhole would have it:
  // x_seen = x (1 - 0.3 r^2), solved for x.
  const double seen_x = (kPlant_px.x - kIntrinsics.cx_px) / kIntrinsics.fx_px;
  const double seen_y = (kPlant_px.y - kIntrinsics.cy_px) / kIntrinsics.fy_px;
  double scale = 1.0;
  for (int i = 0; i < 50; ++i) {
    scale = 1.0 / (1.0 - 0.3 * scale * scale * (seen_x * seen_x + seen_y * seen_y));
  }
  ASSERT_EQ(world.seen.size(), static_cast<std::size_t>(kImages)) << world.last.message;
  EXPECT_NEAR(world.seen[0].instances().at(0).stem_u_px(),
              kIntrinsics.cx_px + kIntrinsics.fx_px * scale * seen_x, 1.5);

  World rectified;
  rectified.info = distort;
  rectified.parameters["rectified"] = true;
  run(rectified);
  expect_all_seen(rectified);
}

}  // namespace
}  // namespace furrow::components
