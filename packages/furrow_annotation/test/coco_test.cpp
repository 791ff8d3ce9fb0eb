#include "furrow_annotation/coco.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "furrow_core/file.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"

namespace furrow::annotation {
namespace {

bool equal_masks(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::countNonZero(a != b) == 0;
}

Dataset small_dataset(const std::filesystem::path& folder) {
  Dataset dataset;
  dataset.name = "rendered";
  dataset.classes = {{"sugar_beet", SubClassKind::kCrop}, {"goosefoot", SubClassKind::kWeed}};
  AnnotatedImage before;
  before.path = folder / "images/0.png";
  before.width_px = 30;
  before.height_px = 20;
  before.sequence = "a";
  before.labelled = false;
  before.stamp = Time::from_nanoseconds(1'000'000'007);
  AnnotatedImage last = before;
  last.path = folder / "images/1.png";
  last.depth_path = folder / "depth/1.png";
  last.labelled = true;
  last.X_FB = geometry::Pose2{1.25, -0.5, 0.01};
  last.velocity_mps = 0.5;
  AnnotatedInstance weed;
  weed.category = "goosefoot";
  weed.box_px = {4, 5, 3, 2};
  weed.mask = (cv::Mat_<std::uint8_t>(2, 3) << 255, 0, 255, 0, 255, 0);
  weed.stem_px = Eigen::Vector2d(5.25, 5.5);
  AnnotatedInstance crop;
  crop.kind = SubClassKind::kCrop;
  crop.category = "sugar_beet";
  crop.box_px = {20, 10, 10, 10};
  crop.mask = cv::Mat(10, 10, CV_8U, cv::Scalar(255));
  last.instances = {weed, crop};
  last.ignore_boxes = {{1, 2, 3, 4}};
  last.instances[0].truncated = true;
  last.instances[1].box_only = true;
  dataset.images = {before, last};
  dataset.resolution_mm_per_px = 0.5;
  return dataset;
}

TEST(Coco, ComesBackAsWritten) {
  TemporaryFolder folder;
  const Dataset written = small_dataset(folder.path());
  ASSERT_TRUE(write_coco(folder.path() / "train.json", written).ok());
  const auto read = read_coco(folder.path() / "train.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->name, "rendered");
  ASSERT_EQ(read->classes.size(), 2u);
  EXPECT_EQ(read->classes[0].kind, SubClassKind::kCrop);
  EXPECT_EQ(read->classes[1].name, "goosefoot");
  ASSERT_EQ(read->images.size(), 2u);
  EXPECT_FALSE(read->images[0].labelled);
  EXPECT_FALSE(read->images[0].X_FB.has_value());
  EXPECT_EQ(read->images[0].stamp->count_ns(), 1'000'000'007);
  const AnnotatedImage& last = read->images[1];
  EXPECT_TRUE(last.labelled);
  EXPECT_EQ(last.sequence, "a");
  EXPECT_EQ(last.path, folder.path() / "images/1.png");
  EXPECT_EQ(last.depth_path, folder.path() / "depth/1.png");
  EXPECT_EQ(last.X_FB->y_m, -0.5);
  EXPECT_EQ(*last.velocity_mps, 0.5);
  ASSERT_EQ(last.instances.size(), 2u);
  EXPECT_EQ(last.instances[0].box_px, written.images[1].instances[0].box_px);
  EXPECT_TRUE(equal_masks(last.instances[0].mask, written.images[1].instances[0].mask));
  EXPECT_EQ(*last.instances[0].stem_px, Eigen::Vector2d(5.25, 5.5));
  EXPECT_EQ(last.instances[1].kind, SubClassKind::kCrop);
  EXPECT_FALSE(last.instances[1].stem_px.has_value());
  EXPECT_EQ(last.ignore_boxes, written.images[1].ignore_boxes);
  EXPECT_EQ(read->resolution_mm_per_px, 0.5);
  EXPECT_EQ(read->images[0].resolution_mm_per_px, 0.5);
  EXPECT_TRUE(last.instances[0].truncated);
  EXPECT_FALSE(last.instances[0].box_only);
  EXPECT_TRUE(last.instances[1].box_only);
  EXPECT_EQ(read->report.annotations, 2u);
  EXPECT_EQ(read->report.box_only, 1u);
  EXPECT_TRUE(read->report.skipped.empty());
}

TEST(Coco, KeepsFileNamesThatAreNotUtf8) {
  TemporaryFolder folder;
  Dataset written = small_dataset(folder.path());
  const std::filesystem::path latin1 = folder.path() /
                                       "images/r\xFC"
                                       "be 1%.png";
  written.images[1].path = latin1;
  ASSERT_TRUE(write_coco(folder.path() / "train.json", written).ok());
  const auto read = read_coco(folder.path() / "train.json");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->images[1].path, latin1);
}

TEST(Coco, RefusesToWriteWhatDoesNotFit) {
  TemporaryFolder folder;
  Dataset dataset = small_dataset(folder.path());
  dataset.images[1].instances[0].category = "unheard_of";
  EXPECT_FALSE(write_coco(folder.path() / "a.json", dataset).ok());
  dataset = small_dataset(folder.path());
  dataset.images[1].instances[1].box_px.x = 25;
  EXPECT_FALSE(write_coco(folder.path() / "a.json", dataset).ok());
}

}  // namespace
}  // namespace furrow::annotation
