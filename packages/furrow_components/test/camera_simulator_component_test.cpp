// The ground truth of a rendered image: the visible part of each plant.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>

#include "feeder.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_components/image_conversions.hpp"
#include "furrow_core/file.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"
#include "furrow_simulation/renderer.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

constexpr std::uint64_t kSeed = 4;

/// A beet, an isolated weed, one at the edge of the beet, and a seedling below the beet.
field::FieldModel small_field() {
  field::FieldModel field{.name = "test", .source = "test", .length_m = 3.0, .width_m = 1.2};
  const auto add = [&](field::PlantKind kind, const char* species, double x_m, double y_m,
                       double radius_m, int leaves) {
    field::Plant plant{.id = static_cast<std::int64_t>(field.plants.size()) + 1,
                       .kind = kind,
                       .species = species,
                       .p_F_m = {x_m, y_m},
                       .radius_m = radius_m,
                       .area_mm2 = 0.5e6 * 3.14 * radius_m * radius_m,
                       .leaves = leaves};
    field.plants.push_back(plant);
  };
  add(field::PlantKind::kCrop, "sugar_beet", 1.20, 0.0, 0.10, 8);
  add(field::PlantKind::kWeed, "chickweed", 1.203, 0.002, 0.004, 2);
  add(field::PlantKind::kWeed, "chickweed", 1.25, 0.06, 0.02, 4);
  add(field::PlantKind::kWeed, "lambsquarters", 1.30, -0.3, 0.02, 4);
  field::sort_plants(field);
  return field;
}

/// Stands still and keeps the first ground truth.
class Feeder final : public graph::Component {
 public:
  Feeder(graph::Context& context, std::optional<furrow_msgs::msg::PlantInstances>& truth)
      : out_(context.output<topics::TrueOdometry>()) {
    context.every(Duration::milliseconds(20), [this](Time now) {
      out_.publish(to_msg(BaseOdometry{now, {}, 0.0, 0.0}, kFieldFrame));
    });
    context.input<topics::TrueInstances>([&truth, &context](const auto& message) {
      if (!truth) truth = *message;
      context.request_stop("finished");
    });
  }
  static void describe(graph::Description& d) {
    d.input<topics::TrueInstances>().output<topics::TrueOdometry>();
  }

 private:
  graph::Output<topics::TrueOdometry> out_;
};

std::optional<furrow_msgs::msg::PlantInstances> truth_of(const std::filesystem::path& field_file,
                                                         bool true_masks) {
  std::optional<furrow_msgs::msg::PlantInstances> truth;
  graph::Registry registry;
  registry.load_library(FURROW_CAMERA_LIBRARY);
  registry.add(feeder_class<Feeder>(truth));
  graph::GraphSpec spec;
  spec.components = {{.name = "camera",
                      .group = "camera",
                      .class_name = "camera_simulator",
                      .parameters = {{"tool_file", std::string(FURROW_TOOL_FILE), {}},
                                     {"field_file", field_file.string(), {}},
                                     {"true_masks", true_masks, {}}}},
                     {.name = "feeder", .group = "feeder", .class_name = "feeder"}};
  graph::Runtime runtime(spec, registry,
                         {.clock = graph::ClockMode::kLockstep, .threads = 1, .seed = kSeed});
  EXPECT_EQ(runtime.run().reason, "finished");
  return truth;
}

TEST(CameraSimulator, TrueMasksAreTheVisiblePartsOfPlants) {
  const field::FieldModel field = small_field();
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / "camera_simulator_component_test.csv";
  ASSERT_TRUE(write_file_atomically(file, *field::to_csv(field)).ok());

  const geometry::CameraModel camera = geometry::load_tool_model(FURROW_TOOL_FILE).cameras.front();
  simulation::Renderer renderer(field, {}, kSeed);
  const simulation::Frame frame =
      renderer.render(geometry::PinholeCamera(camera.intrinsics), camera.X_BC, 0);

  const auto truth = truth_of(file, true);
  ASSERT_TRUE(truth);
  // In the order of the field; all stems are in the image.
  ASSERT_EQ(truth->instances().size(), field.plants.size());
  std::size_t shown = 0;
  for (std::size_t i = 0; i < field.plants.size(); ++i) {
    const auto& instance = truth->instances()[i];
    const auto& box = instance.box();
    const auto visible = std::ranges::find(frame.plants, i, &simulation::VisiblePlant::plant_index);
    if (visible == frame.plants.end()) {
      EXPECT_EQ(box.width(), 0U);
      EXPECT_TRUE(instance.mask_runs().empty());
      continue;
    }
    ++shown;
    const auto mask = mask_from_runs(instance.mask_runs(), static_cast<int>(box.width()),
                                     static_cast<int>(box.height()));
    ASSERT_TRUE(mask.ok());
    const cv::Rect where(static_cast<int>(box.x_offset()), static_cast<int>(box.y_offset()),
                         mask->cols, mask->rows);
    const cv::Mat expected = frame.plant_index(where) == static_cast<int>(i);
    EXPECT_EQ(cv::countNonZero(*mask != expected), 0);
    EXPECT_EQ(cv::countNonZero(*mask), visible->visible_px);
  }
  EXPECT_GE(shown, 3U);

  const auto plain = truth_of(file, false);
  ASSERT_TRUE(plain);
  EXPECT_TRUE(plain->instances()[0].mask_runs().empty());
  EXPECT_GT(plain->instances()[0].box().width(), 0U);
  std::filesystem::remove(file);
}

}  // namespace
}  // namespace furrow::components
