#include "furrow_field/annotations.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "furrow_core/random.hpp"
#include "furrow_field/image_layout.hpp"

namespace furrow::field {
namespace {

/// A small data set: a crop with a stem keypoint, a weed of two parts, a crowd, on two images.
const std::string kCoco = R"({
  "images": [{"id": 10, "file_name": "b.png", "width": 100, "height": 80},
             {"id": 2, "file_name": "a.png", "width": 100, "height": 80}],
  "categories": [{"id": 1, "name": "crop", "keypoints": ["tip", "stem"]},
                 {"id": 2, "name": "Cirsium"}, {"id": 3, "name": "unused"}],
  "annotations": [
    {"id": 1, "image_id": 10, "category_id": 1, "segmentation": [[10,10, 30,10, 30,20, 10,20]],
     "keypoints": [0,0,0, 12.5,11.5,2]},
    {"id": 2, "image_id": 2, "category_id": 2,
     "segmentation": [[0,0, 10,0, 10,10, 0,10], [20,0, 30,0, 30,10, 20,10]]},
    {"id": 3, "image_id": 2, "category_id": 2, "iscrowd": 1,
     "segmentation": {"counts": [1, 2], "size": [80, 100]}}]})";

const std::map<std::string, CategoryMeaning> kMeanings = {
    {"Cirsium", {PlantKind::kWeed, "thistle"}}};

std::string changed(const std::string& from, const std::string& to) {
  std::string text = kCoco;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void expect_error(const std::string& json, std::initializer_list<const char*> parts) {
  const auto images = parse_coco(json, "set.json", kMeanings);
  ASSERT_FALSE(images.ok()) << json;
  EXPECT_EQ(images.error().message.rfind("set.json", 0), 0u);
  for (const char* part : parts) {
    EXPECT_NE(images.error().message.find(part), std::string::npos) << images.error().message;
  }
}

TEST(Polygon, AreaAndCentroidOfARegularPolygonAnywhere) {
  Random random(1);
  for (int n = 3; n < 40; ++n) {
    const Eigen::Vector2d middle(random.uniform(-9e4, 9e4), random.uniform(-9e4, 9e4));
    const double radius = random.uniform(1.0, 50.0);
    Polygon polygon;
    for (int i = 0; i < n; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / n * (n % 2 == 0 ? 1.0 : -1.0);
      polygon.push_back(middle + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
    }
    const double area = 0.5 * n * radius * radius * std::sin(2.0 * std::numbers::pi / n);
    EXPECT_NEAR(polygon_area_px2(polygon), area, 1e-6 * area);
    EXPECT_NEAR((*centroid_px({polygon}) - middle).norm(), 0.0, 1e-6);
  }
}

TEST(Polygon, CentroidWeighsPartsByAreaInEitherOrientation) {
  const Polygon large = {{0, 0}, {4, 0}, {4, 1}, {0, 1}};
  const Polygon small = {{10, 0}, {10, 1}, {12, 1}, {12, 0}};
  const Eigen::Vector2d expected =
      (4.0 * Eigen::Vector2d(2, 0.5) + 2.0 * Eigen::Vector2d(11, 0.5)) / 6.0;
  EXPECT_NEAR((*centroid_px({large, small}) - expected).norm(), 0.0, 1e-12);
}

TEST(Polygon, WithoutAreaTheMeanOfThePoints) {
  EXPECT_EQ(*centroid_px({{{3, 4}}}), Eigen::Vector2d(3, 4));
  EXPECT_EQ(*centroid_px({{{0, 0}, {2, 4}}}), Eigen::Vector2d(1, 2));
  EXPECT_FALSE(centroid_px({}).has_value());
  EXPECT_FALSE(centroid_px({{}}).has_value());
  EXPECT_EQ(polygon_area_px2({}), 0.0);
  EXPECT_EQ(polygon_area_px2({{0, 0}, {1, 1}}), 0.0);
}

TEST(Coco, ReadsPolygonsSpeciesAndStems) {
  const auto images = parse_coco(kCoco, "set.json", kMeanings);
  ASSERT_TRUE(images.ok()) << images.error().message;
  ASSERT_EQ(images->size(), 2u);
  EXPECT_EQ((*images)[0].name, "b.png");
  ASSERT_EQ((*images)[0].plants.size(), 1u);
  const AnnotatedPlant& crop = (*images)[0].plants[0];
  EXPECT_EQ(crop.kind, PlantKind::kCrop);
  EXPECT_EQ(crop.stem_px, Eigen::Vector2d(12, 11));
  EXPECT_DOUBLE_EQ(polygon_area_px2(crop.polygons_px.at(0)), 200.0);
  ASSERT_EQ((*images)[1].plants.size(), 1u);
  const AnnotatedPlant& weed = (*images)[1].plants[0];
  EXPECT_EQ(weed.species, "thistle");
  EXPECT_FALSE(weed.stem_px.has_value());
  EXPECT_NEAR((*centroid_px(weed.polygons_px) - Eigen::Vector2d(14.5, 4.5)).norm(), 0.0, 1e-12);
}

TEST(Coco, AStemThatIsNotLabelledIsNoStem) {
  const auto images = parse_coco(changed("12.5,11.5,2", "0,0,0"), "set.json", kMeanings);
  ASSERT_TRUE(images.ok());
  EXPECT_FALSE((*images)[0].plants[0].stem_px.has_value());
}

TEST(Coco, ErrorsNameFileEntryAndKey) {
  expect_error("", {"parse error"});
  expect_error("[]", {"object"});
  expect_error("{}", {"images", "not a list"});
  expect_error(changed("\"Cirsium\"", "\"Rumex\""),
               {"annotations[1]", "category_id", "'Rumex' is a crop or a weed"});
  expect_error(changed("\"image_id\": 10", "\"image_id\": 11"), {"annotations[0]", "no image 11"});
  expect_error(changed("\"category_id\": 1", "\"category_id\": 9"), {"no category 9"});
  expect_error(changed("\"image_id\": 10, ", ""), {"annotations[0]", "image_id", "missing"});
  expect_error(changed("\"width\": 100", "\"width\": 0"), {"images[0]", "width"});
  expect_error(changed("\"width\": 100", "\"width\": \"w\""), {"images[0]", "width"});
  expect_error(changed("\"file_name\": \"b.png\"", "\"file_name\": 1"), {"file_name"});
  expect_error(changed("\"id\": 2, \"file_name\"", "\"id\": 10, \"file_name\""),
               {"images[1]", "unique"});
  expect_error(changed("\"id\": 2, \"name\"", "\"id\": 1, \"name\""), {"categories[1]", "unique"});
  expect_error(changed("[[10,10, 30,10, 30,20, 10,20]]", "[[10,10, 30,10, 30]]"), {"at least six"});
  expect_error(changed("[[10,10, 30,10, 30,20, 10,20]]", "[]"), {"no polygon"});
  expect_error(changed("[[10,10,", "[[1e9,10,"), {"segmentation", "coordinate"});
  expect_error(changed("[[10,10,", "[[null,10,"), {"segmentation", "coordinate"});
  expect_error(changed("[[10,10, 30,10, 30,20, 10,20]]", "{\"counts\": \"x\"}"), {"run-length"});
  expect_error(changed("[0,0,0, 12.5,11.5,2]", "[0,0,0]"), {"keypoints", "fewer"});
}

TEST(Coco, SurvivesDamage) {
  Random random(2);
  const auto last = static_cast<std::int64_t>(kCoco.size()) - 1;
  for (int i = 0; i < 500; ++i) {
    std::string text = kCoco;
    if (i % 2 == 0) {
      text.resize(static_cast<std::size_t>(random.integer(0, last)));
      EXPECT_FALSE(parse_coco(text, "set.json", kMeanings).ok());
    } else {
      for (int k = 0; k < 3; ++k) {
        text[static_cast<std::size_t>(random.integer(0, last))] =
            static_cast<char>(random.integer(32, 126));
      }
      const auto images = parse_coco(text, "set.json", kMeanings);
      EXPECT_TRUE(images.ok() || images.error().message.rfind("set.json", 0) == 0);
    }
  }
}

AnnotatedImage image_with_stem(const std::string& name, double u, double v) {
  AnnotatedPlant plant;
  plant.stem_px = Eigen::Vector2d(u, v);
  plant.polygons_px = {{{u - 5, v}, {u + 5, v}, {u + 5, v + 10}, {u - 5, v + 10}}};
  return {name, 100, 80, {plant}};
}

TEST(ImageLayout, PlacesImagesOneAfterAnother) {
  const std::vector<AnnotatedImage> images = {image_with_stem("a", 10, 70),
                                              image_with_stem("b", 99, 0)};
  LayoutParameters parameters{.ground_resolution_mm_per_px = 2.0, .gap_m = 0.5};
  const auto laid = lay_images(images, parameters, "n", "imported: test");
  ASSERT_TRUE(laid.ok()) << laid.error().message;
  const FieldModel& field = laid->field;
  EXPECT_EQ(field.source, "imported: test");
  EXPECT_NEAR(field.length_m, 2 * 0.16 + 0.5, 1e-12);
  EXPECT_NEAR(field.width_m, 0.2, 1e-12);
  ASSERT_EQ(field.plants.size(), 2u);
  // Pixel row 70 of 80: its middle lies 9.5 pixels above the lower edge, where the image begins.
  EXPECT_NEAR((field.plants[0].p_F_m - Eigen::Vector2d(0.019, 0.079)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((field.plants[1].p_F_m - Eigen::Vector2d(0.66 + 0.159, -0.099)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(field.plants[0].area_mm2, 100.0 * 4.0, 1e-9);
  EXPECT_NEAR(field.plants[0].radius_m, 2e-3 * std::hypot(5.0, 10.0), 1e-12);

  parameters.travel = "right";
  const auto turned = lay_images(images, parameters, "n", "imported: test");
  ASSERT_TRUE(turned.ok());
  EXPECT_NEAR(turned->field.length_m, 2 * 0.2 + 0.5, 1e-12);
  EXPECT_NEAR((turned->field.plants[0].p_F_m - Eigen::Vector2d(0.021, -0.061)).norm(), 0.0, 1e-12);
}

TEST(ImageLayout, PixelsAndFieldPointsMapBothWays) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const ImagePlacement placement{
        "i", 640, 480, random.uniform(1e-4, 1e-2), i % 2 == 0, random.uniform(0.0, 20.0)};
    const Eigen::Vector2d pixel(random.uniform(-0.5, 639.5), random.uniform(-0.5, 479.5));
    const Eigen::Vector2d p_m = placement.to_field(pixel);
    EXPECT_NEAR((placement.to_pixel(p_m) - pixel).norm(), 0.0, 1e-8);
    EXPECT_GE(p_m.x(), placement.x_m);
    EXPECT_LE(p_m.x(), placement.x_m + placement.length_m());
    EXPECT_LE(std::abs(p_m.y()), 0.5 * placement.width_m() + 1e-12);
  }
}

TEST(ImageLayout, ErrorsNameImageAndPlant) {
  const auto error_of = [](std::vector<AnnotatedImage> images, const LayoutParameters& p = {}) {
    const auto laid = lay_images(images, p, "n", "s");
    return laid.ok() ? std::string() : laid.error().message;
  };
  EXPECT_NE(error_of({}).find("no image"), std::string::npos);
  EXPECT_NE(error_of({image_with_stem("a", 100, 5)}).find("'a': plant 0 stands outside"),
            std::string::npos);
  EXPECT_NE(error_of({image_with_stem("a", std::nan(""), 5)}).find("outside"), std::string::npos);
  EXPECT_NE(error_of({{"e", 10, 10, {AnnotatedPlant{}}}}).find("'e': plant 0 has neither"),
            std::string::npos);
  EXPECT_NE(error_of({{"z", 0, 10, {}}}).find("'z': its size"), std::string::npos);
  EXPECT_NE(error_of({image_with_stem("a", 5, 5)}, {.ground_resolution_mm_per_px = 0.0})
                .find("ground_resolution_mm_per_px"),
            std::string::npos);
  EXPECT_NE(error_of({image_with_stem("a", 5, 5)}, {.travel = "left"}).find("travel"),
            std::string::npos);
}

}  // namespace
}  // namespace furrow::field
