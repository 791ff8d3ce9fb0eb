#include "furrow_vision/dataset_conversion.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <set>

#include "furrow_annotation/coco.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"

namespace furrow::vision {
namespace {

/// One plant of 20 x 12 px at (8, 4), its stem in the middle of the pixel (17, 9).
AnnotatedImage image_of(const std::filesystem::path& path) {
  AnnotatedImage image;
  image.path = path;
  image.width_px = 60;
  image.height_px = 40;
  AnnotatedInstance plant;
  plant.kind = SubClassKind::kCrop;
  plant.category = "beet";
  plant.box_px = {8, 4, 20, 12};
  plant.mask = cv::Mat(12, 20, CV_8U, cv::Scalar(255));
  plant.stem_px = {17.0, 9.0};
  image.instances.push_back(plant);
  return image;
}

Dataset dataset_of(const std::filesystem::path& folder, int images) {
  Dataset dataset{.name = "made", .classes = {{"beet", SubClassKind::kCrop}}, .images = {}};
  for (int i = 0; i < images; ++i) {
    const auto path = folder / ("in_" + std::to_string(i) + ".png");
    cv::imwrite(path.string(), cv::Mat(40, 60, CV_8UC3, cv::Scalar(20, i, 200)));
    dataset.images.push_back(image_of(path));
  }
  return dataset;
}

std::set<std::string> names_of(const Dataset& part) {
  std::set<std::string> names;
  for (const auto& image : part.images) names.insert(image.path.filename().string());
  return names;
}

TEST(DatasetSplit, IsWholeDisjointAndRepeatable) {
  const TemporaryFolder folder;
  const Dataset dataset = dataset_of(folder.path(), 20);
  const ConversionParameters parameters{.validation_share = 0.2, .evaluation_share = 0.5};
  const DatasetSplit split = split_dataset(dataset, parameters, 3);
  EXPECT_EQ(split.evaluation.images.size(), 10u);
  EXPECT_EQ(split.validation.images.size(), 2u);
  EXPECT_EQ(split.train.images.size(), 8u);
  std::set<std::string> all;
  for (const Dataset* part : {&split.train, &split.validation, &split.evaluation}) {
    all.merge(names_of(*part));
    EXPECT_EQ(part->classes.size(), 1u);
  }
  EXPECT_EQ(all.size(), 20u);
  EXPECT_EQ(names_of(split_dataset(dataset, parameters, 3).evaluation), names_of(split.evaluation));
  EXPECT_NE(names_of(split_dataset(dataset, parameters, 4).evaluation), names_of(split.evaluation));
}

TEST(DatasetSplit, KeepsSequencesTogetherAndSurvivesFewImages) {
  const TemporaryFolder folder;
  Dataset dataset = dataset_of(folder.path(), 12);
  for (std::size_t i = 0; i < dataset.images.size(); ++i) {
    dataset.images[i].sequence = "s" + std::to_string(i / 3);
  }
  const DatasetSplit split = split_dataset(dataset, {}, 1);
  for (const Dataset* part : {&split.train, &split.validation, &split.evaluation}) {
    EXPECT_EQ(part->images.size() % 3, 0u);
    EXPECT_FALSE(part->images.empty());
  }
  EXPECT_EQ(split_dataset({}, {}, 1).train.images.size(), 0u);
  dataset.images.resize(1);
  EXPECT_EQ(split_dataset(dataset, {}, 1).evaluation.images.size(), 1u);
  EXPECT_EQ(split_dataset(dataset, {.evaluation_share = 0.0}, 1).train.images.size(), 1u);
}

TEST(ScaleImage, ScalesMasksAndStems) {
  AnnotatedImage image = image_of("none.png");
  image.bgr = cv::Mat(40, 60, CV_8UC3, cv::Scalar(1, 2, 3));
  image.vegetation = cv::Mat(40, 60, CV_8U, cv::Scalar(1));
  image.ignore_boxes = {{10, 20, 5, 4}};
  image.resolution_mm_per_px = 0.3;
  scale_image(image, 0.5);
  EXPECT_EQ(image.ignore_boxes, std::vector<cv::Rect>({{5, 10, 3, 2}}));
  EXPECT_NEAR(*image.resolution_mm_per_px, 0.6, 1e-12);
  EXPECT_EQ(image.bgr.size(), cv::Size(30, 20));
  EXPECT_EQ(image.width_px, 30);
  ASSERT_EQ(image.instances.size(), 1u);
  EXPECT_EQ(image.instances[0].box_px, cv::Rect(4, 2, 10, 6));
  EXPECT_EQ(cv::countNonZero(image.instances[0].mask), 60);
  // The pixel's middle is at 17.5, half of which is 8.75 from the image's edge.
  EXPECT_NEAR(image.instances[0].stem_px->x(), 8.25, 1e-12);
  EXPECT_NEAR(image.instances[0].stem_px->y(), 4.25, 1e-12);
  EXPECT_EQ(cv::countNonZero(image.vegetation), 600);
  scale_image(image, 0.01);  // nothing remains of a plant that covers a tenth
  EXPECT_TRUE(image.instances.empty());
}

TEST(ConvertDataset, WritesPartsThatComeBack) {
  const TemporaryFolder folder;
  Dataset dataset = dataset_of(folder.path(), 6);
  dataset.resolution_mm_per_px = 0.3;
  const auto out = folder.path() / "out";
  std::size_t done = 0;
  ASSERT_TRUE(
      convert_dataset(dataset, {.scale = 0.5}, 1, out, [&](std::size_t n) { done = n; }).ok());
  EXPECT_EQ(done, 6u);
  auto train = annotation::read_coco(out / "train.json"),
       evaluation = annotation::read_coco(out / "evaluation.json");
  ASSERT_TRUE(train.ok() && evaluation.ok());
  EXPECT_EQ(train->images.size(), 2u);
  ASSERT_EQ(evaluation->images.size(), 3u);
  EXPECT_EQ(train->images[0].width_px, 30);
  EXPECT_NEAR(*train->resolution_mm_per_px, 0.6, 1e-12);
  EXPECT_NEAR(*evaluation->resolution_mm_per_px, 0.3, 1e-12);
  EXPECT_EQ(evaluation->images[0].width_px, 60);
  ASSERT_TRUE(load_pixels(train->images[0]).ok());
  ASSERT_TRUE(load_pixels(evaluation->images[0]).ok());
  EXPECT_EQ(train->images[0].instances[0].kind, SubClassKind::kCrop);
}

TEST(ConvertDataset, SaysWhatFails) {
  const TemporaryFolder folder;
  Dataset dataset = dataset_of(folder.path(), 2);
  const auto ignore = [](std::size_t) {};
  const Status range = convert_dataset(dataset, {.scale = 0.0}, 1, folder.path() / "out", ignore);
  ASSERT_FALSE(range.ok());
  EXPECT_NE(range.error().message.find("scale"), std::string::npos);
  dataset.images[0].path = folder.path() / "gone.png";
  const Status gone = convert_dataset(dataset, {}, 1, folder.path() / "out", ignore);
  ASSERT_FALSE(gone.ok());
  EXPECT_NE(gone.error().message.find("gone.png"), std::string::npos);
}

}  // namespace
}  // namespace furrow::vision
