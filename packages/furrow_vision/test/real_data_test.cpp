// Real photographs, kept outside the project: CWFID (Haug and Ostermann 2014) and Carrot-Weed
// (Lameski et al. 2017). Looked for in FURROW_DATA_DIR, else beside the project.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "furrow_annotation/carrot_weed.hpp"
#include "furrow_annotation/cwfid.hpp"
#include "furrow_vision/annotated_image.hpp"
#include "furrow_vision/image_file.hpp"
#include "furrow_vision/metrics.hpp"
#include "furrow_vision/vegetation_index.hpp"

namespace furrow::vision {
namespace {

namespace fs = std::filesystem;

fs::path data_folder() {
  if (const char* given = std::getenv("FURROW_DATA_DIR")) return given;
  return fs::path(FURROW_TEST_DATA_DIR) / "../../../../shared/data";
}

/// Vegetation IoU over the first images: enough to notice a loss, few enough to be quick.
double vegetation_iou(Dataset& dataset, std::size_t images) {
  SemanticScore score;
  for (std::size_t i = 0; i < std::min(images, dataset.images.size()); ++i) {
    const Status loaded = load_pixels(dataset.images[i]);
    EXPECT_TRUE(loaded.ok()) << loaded.error().message;
    if (!loaded) continue;
    score.add_vegetation(dataset.images[i].vegetation,
                         segment_vegetation(dataset.images[i].bgr, {}).mask);
  }
  return score.vegetation().iou();
}

TEST(RealData, CwfidVegetation) {
  const fs::path folder = data_folder() / "cwfid";
  if (!fs::exists(folder)) GTEST_SKIP() << "skipped: no real images in " << folder;
  auto dataset = annotation::read_cwfid(folder, read_mask);
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  EXPECT_GT(vegetation_iou(*dataset, 8), 0.87);
}

TEST(RealData, CarrotWeedVegetation) {
  const fs::path folder = data_folder() / "carrot_weed";
  if (!fs::exists(folder)) GTEST_SKIP() << "skipped: no real images in " << folder;
  auto dataset = annotation::read_carrot_weed(folder, read_mask);
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  EXPECT_GT(vegetation_iou(*dataset, 5), 0.84);
}

}  // namespace
}  // namespace furrow::vision
