#include "furrow_field/image_layout.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "furrow_core/random.hpp"

namespace furrow::field {
namespace {

PlantImage image_with_stem(const std::string& name, double u, double v) {
  ImagePlant plant;
  plant.stem_px = {u, v};
  plant.area_px2 = 100.0;
  plant.radius_px = 11.0;
  return {name, 100, 80, {plant}};
}

TEST(ImageLayout, PlacesImagesOneAfterAnother) {
  const std::vector<PlantImage> images = {image_with_stem("a", 10, 70),
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
  EXPECT_NEAR(field.plants[0].radius_m, 2e-3 * 11.0, 1e-12);

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

TEST(ImageLayout, LeavesOutPlantsWhoseStemIsOutsideTheirImage) {
  const auto laid = lay_images({image_with_stem("a", 100, 5), image_with_stem("b", std::nan(""), 5),
                                image_with_stem("c", 99.5, -0.5)},
                               {}, "n", "s");
  ASSERT_TRUE(laid.ok()) << laid.error().message;
  EXPECT_EQ(laid->field.plants.size(), 1u);
  EXPECT_EQ(laid->outside, 2u);
}

TEST(ImageLayout, ErrorsNameTheImage) {
  const auto error_of = [](std::vector<PlantImage> images, const LayoutParameters& p = {}) {
    const auto laid = lay_images(images, p, "n", "s");
    return laid.ok() ? std::string() : laid.error().message;
  };
  EXPECT_NE(error_of({}).find("no image"), std::string::npos);
  EXPECT_NE(error_of({{"z", 0, 10, {}}}).find("'z': its size"), std::string::npos);
  EXPECT_NE(error_of({image_with_stem("a", 5, 5)}, {.ground_resolution_mm_per_px = 0.0})
                .find("ground_resolution_mm_per_px"),
            std::string::npos);
  EXPECT_NE(error_of({image_with_stem("a", 5, 5)}, {.travel = "left"}).find("travel"),
            std::string::npos);
}

}  // namespace
}  // namespace furrow::field
