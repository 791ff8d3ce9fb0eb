#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "furrow_core/file.hpp"
#include "furrow_vision/dataset_carrot_weed.hpp"
#include "furrow_vision/dataset_cwfid.hpp"
#include "temporary_folder.hpp"

namespace furrow::vision {
namespace {

namespace fs = std::filesystem;

/// One 60x40 image with two squares of vegetation: columns 5..14 and 30..39, rows 10..19.
void make_cwfid(const fs::path& folder, const std::string& yaml) {
  for (const char* part : {"images", "masks", "annotations"}) fs::create_directories(folder / part);
  cv::imwrite((folder / "images/001_image.png").string(),
              cv::Mat(40, 60, CV_8UC3, cv::Scalar(90, 96, 90)));
  cv::Mat mask(40, 60, CV_8U, cv::Scalar(255));
  mask(cv::Rect(5, 10, 10, 10)).setTo(0);
  mask(cv::Rect(30, 10, 10, 10)).setTo(0);
  cv::imwrite((folder / "masks/001_mask.png").string(), mask);
  ASSERT_TRUE(write_file_atomically(folder / "annotations/001_annotation.yaml", yaml).ok());
}

TEST(Cwfid, CutsPolygonsWithTheVegetation) {
  TemporaryFolder folder;
  make_cwfid(folder.path(),
             "filename: 001_image.png\nannotation:\n- type: crop\n  points:\n"
             "    x: [0.0, 20.0, 20.0, 0.0]\n    y: [0.0, 0.0, 14.0, 14.0]\n"
             "- type: weed\n  points:\n    x: 33\n    y: 15\n"
             "- type: weed\n  points: {x: [50, 55, 55], y: [30, 30, 35]}\n");
  auto dataset = read_cwfid(folder.path());
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  ASSERT_EQ(dataset->images.size(), 1u);
  AnnotatedImage& image = dataset->images[0];
  EXPECT_EQ(cv::countNonZero(image.vegetation), 200);
  ASSERT_EQ(image.instances.size(), 2u);  // the third polygon holds soil only
  EXPECT_EQ(image.instances[0].kind, SubClassKind::kCrop);
  EXPECT_EQ(image.instances[0].box_px, cv::Rect(5, 10, 10, 5));  // rows 10 to 14
  EXPECT_EQ(image.instances[1].kind, SubClassKind::kWeed);
  EXPECT_EQ(image.instances[1].box_px, cv::Rect(30, 10, 10, 10));
  ASSERT_TRUE(load_pixels(image).ok());
  EXPECT_EQ(image.bgr.size(), cv::Size(60, 40));
  const cv::Mat labels = semantic_labels(image);
  EXPECT_EQ(labels.at<std::uint8_t>(12, 6), 2);
  EXPECT_EQ(labels.at<std::uint8_t>(12, 31), 1);
}

TEST(Cwfid, TakesASinglePolygonWithoutAList) {
  TemporaryFolder folder;
  make_cwfid(folder.path(),
             "annotation:\n  type: weed\n  points: {x: [0, 20, 20, 0], y: [0, 0, 30, 30]}\n");
  const auto dataset = read_cwfid(folder.path());
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  EXPECT_EQ(dataset->images[0].instances.size(), 1u);
}

TEST(Cwfid, NamesFileAndKeyOfWhatIsMalformed) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"annotation: [\n", "line"},
      {"other: 1\n", "annotation"},
      {"annotation:\n- points: {x: [1], y: [1]}\n", "annotation[0].type"},
      {"annotation:\n- {type: stone, points: {x: [1], y: [1]}}\n", "stone"},
      {"annotation:\n- {type: crop}\n", "annotation[0].points"},
      {"annotation:\n- {type: crop, points: {x: [1, 2, 3], y: [1, 2]}}\n", "differ in length"},
      {"annotation:\n- {type: crop, points: {x: [1, .nan, 3], y: [1, 2, 3]}}\n", "points.x"},
      {"annotation:\n- {type: crop, points: {x: [a, b, c], y: [1, 2, 3]}}\n", "points.x"}};
  for (const auto& [yaml, expected] : cases) {
    TemporaryFolder folder;
    make_cwfid(folder.path(), yaml);
    const auto dataset = read_cwfid(folder.path());
    ASSERT_FALSE(dataset.ok()) << yaml;
    EXPECT_NE(dataset.error().message.find("001_annotation.yaml"), std::string::npos);
    EXPECT_NE(dataset.error().message.find(expected), std::string::npos) << dataset.error().message;
  }
}

TEST(Cwfid, SaysWhichFileIsMissingOrBroken) {
  TemporaryFolder folder;
  EXPECT_EQ(read_cwfid(folder.path() / "nowhere").error().code, ErrorCode::kNotFound);
  make_cwfid(folder.path(), "annotation: []\n");
  EXPECT_TRUE(read_cwfid(folder.path()).ok());
  ASSERT_TRUE(write_file_atomically(folder.path() / "masks/001_mask.png", "not a picture").ok());
  const auto broken = read_cwfid(folder.path());
  ASSERT_FALSE(broken.ok());
  EXPECT_NE(broken.error().message.find("001_mask.png"), std::string::npos);
  fs::remove(folder.path() / "images/001_image.png");
  EXPECT_EQ(read_cwfid(folder.path()).error().code, ErrorCode::kNotFound);
}

TEST(CarrotWeed, MakesInstancesOfComponents) {
  TemporaryFolder folder;
  fs::create_directories(folder.path() / "images");
  fs::create_directories(folder.path() / "plant_masks");
  cv::Mat labels = cv::Mat::zeros(40, 60, CV_8U);
  labels(cv::Rect(5, 5, 10, 10)).setTo(2);
  labels(cv::Rect(15, 15, 10, 10)).setTo(1);  // touches the crop at a corner only
  labels(cv::Rect(40, 30, 2, 2)).setTo(1);    // too small for an instance
  cv::imwrite((folder.path() / "plant_masks/IMG_1.png").string(), labels);
  cv::imwrite((folder.path() / "images/IMG_1.jpg").string(),
              cv::Mat(40, 60, CV_8UC3, cv::Scalar::all(80)));
  auto dataset = read_carrot_weed(folder.path());
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  const AnnotatedImage& image = dataset->images.at(0);
  ASSERT_EQ(image.instances.size(), 2u);
  EXPECT_EQ(image.instances[0].kind, SubClassKind::kWeed);
  EXPECT_EQ(image.instances[0].box_px, cv::Rect(15, 15, 10, 10));
  EXPECT_EQ(image.instances[1].category, "carrot");
  EXPECT_EQ(cv::countNonZero(image.vegetation), 204);

  labels.at<std::uint8_t>(0, 0) = 3;
  cv::imwrite((folder.path() / "plant_masks/IMG_1.png").string(), labels);
  const auto unknown = read_carrot_weed(folder.path());
  ASSERT_FALSE(unknown.ok());
  EXPECT_NE(unknown.error().message.find("label 3"), std::string::npos);
}

TEST(LoadPixels, RefusesWhatIsNoImageOfTheSizeAnnotated) {
  TemporaryFolder folder;
  AnnotatedImage image;
  image.path = folder.path() / "a.png";
  EXPECT_EQ(load_pixels(image).error().code, ErrorCode::kNotFound);
  ASSERT_TRUE(write_file_atomically(image.path, "").ok());
  EXPECT_EQ(load_pixels(image).error().code, ErrorCode::kParse);
  cv::imwrite(image.path.string(), cv::Mat(8, 9, CV_8UC3, cv::Scalar::all(1)));
  image.width_px = 8;
  image.height_px = 8;
  EXPECT_NE(load_pixels(image).error().message.find("9x8"), std::string::npos);
  // Cut off in the middle of its data.
  cv::Mat noise(64, 64, CV_8UC3);
  cv::randu(noise, 0, 255);
  std::vector<std::uint8_t> bytes;
  cv::imencode(".png", noise, bytes);
  image.width_px = image.height_px = 0;
  ASSERT_TRUE(
      write_file_atomically(image.path, {reinterpret_cast<const char*>(bytes.data()), 40}).ok());
  EXPECT_EQ(load_pixels(image).error().code, ErrorCode::kParse);
}

}  // namespace
}  // namespace furrow::vision
