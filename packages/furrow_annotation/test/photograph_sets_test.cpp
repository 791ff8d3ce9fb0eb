// The readers of CWFID and Carrot-Weed, on folders made here.
#include <gtest/gtest.h>

#include <map>
#include <opencv2/core.hpp>

#include "furrow_annotation/carrot_weed.hpp"
#include "furrow_annotation/cwfid.hpp"
#include "furrow_annotation/read_dataset.hpp"
#include "furrow_core/file.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"

namespace furrow::annotation {
namespace {

namespace fs = std::filesystem;

/// Masks by file name, in place of image files.
class Masks {
 public:
  void put(const std::string& name, const cv::Mat& mask) { masks_[name] = mask; }
  [[nodiscard]] MaskReader reader() const {
    return [this](const fs::path& file) -> Result<cv::Mat> {
      const auto found = masks_.find(file.filename().string());
      if (found != masks_.end()) return found->second.clone();
      return Error{ErrorCode::kParse, file.string() + ": not an image, or a truncated one"};
    };
  }

 private:
  std::map<std::string, cv::Mat> masks_;
};

void touch(const fs::path& file) {
  fs::create_directories(file.parent_path());
  ASSERT_TRUE(write_file_atomically(file, "").ok());
}

/// One 60x40 image with two squares of vegetation: columns 5..14 and 30..39, rows 10..19.
Masks make_cwfid(const fs::path& folder, const std::string& yaml) {
  touch(folder / "images/001_image.png");
  cv::Mat mask(40, 60, CV_8U, cv::Scalar(255));
  mask(cv::Rect(5, 10, 10, 10)).setTo(0);
  mask(cv::Rect(30, 10, 10, 10)).setTo(0);
  Masks masks;
  masks.put("001_mask.png", mask);
  EXPECT_TRUE(write_file_atomically(folder / "annotations/001_annotation.yaml", yaml).ok());
  return masks;
}

TEST(Cwfid, CutsPolygonsWithTheVegetation) {
  TemporaryFolder folder;
  const Masks masks = make_cwfid(folder.path(),
                                 "filename: 001_image.png\nannotation:\n- type: crop\n  points:\n"
                                 "    x: [0.0, 20.0, 20.0, 0.0]\n    y: [0.0, 0.0, 14.0, 14.0]\n"
                                 "- type: weed\n  points:\n    x: 33\n    y: 15\n"
                                 "- type: weed\n  points: {x: [50, 55, 55], y: [30, 30, 35]}\n");
  auto dataset = read_cwfid(folder.path(), masks.reader());
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  ASSERT_EQ(dataset->images.size(), 1u);
  AnnotatedImage& image = dataset->images[0];
  EXPECT_EQ(cv::countNonZero(image.vegetation), 200);
  ASSERT_EQ(image.instances.size(), 2u);  // the third polygon holds soil only
  EXPECT_EQ(image.instances[0].kind, SubClassKind::kCrop);
  EXPECT_EQ(image.instances[0].box_px, cv::Rect(5, 10, 10, 5));  // rows 10 to 14
  EXPECT_EQ(image.instances[1].kind, SubClassKind::kWeed);
  EXPECT_EQ(image.instances[1].box_px, cv::Rect(30, 10, 10, 10));
}

TEST(Cwfid, TakesASinglePolygonWithoutAList) {
  TemporaryFolder folder;
  const Masks masks =
      make_cwfid(folder.path(),
                 "annotation:\n  type: weed\n  points: {x: [0, 20, 20, 0], y: [0, 0, 30, 30]}\n");
  const auto dataset = read_cwfid(folder.path(), masks.reader());
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
    const Masks masks = make_cwfid(folder.path(), yaml);
    const auto dataset = read_cwfid(folder.path(), masks.reader());
    ASSERT_FALSE(dataset.ok()) << yaml;
    EXPECT_NE(dataset.error().message.find("001_annotation.yaml"), std::string::npos);
    EXPECT_NE(dataset.error().message.find(expected), std::string::npos) << dataset.error().message;
  }
}

TEST(Cwfid, SaysWhichFileIsMissingOrBroken) {
  TemporaryFolder folder;
  EXPECT_EQ(read_cwfid(folder.path() / "nowhere", Masks().reader()).error().code,
            ErrorCode::kNotFound);
  const Masks masks = make_cwfid(folder.path(), "annotation: []\n");
  EXPECT_TRUE(read_cwfid(folder.path(), masks.reader()).ok());
  const auto broken = read_cwfid(folder.path(), Masks().reader());
  ASSERT_FALSE(broken.ok());
  EXPECT_NE(broken.error().message.find("001_mask.png"), std::string::npos);
  fs::remove(folder.path() / "images/001_image.png");
  EXPECT_EQ(read_cwfid(folder.path(), masks.reader()).error().code, ErrorCode::kNotFound);
}

TEST(CarrotWeed, MakesInstancesOfComponents) {
  TemporaryFolder folder;
  touch(folder.path() / "images/IMG_1.jpg");
  touch(folder.path() / "plant_masks/IMG_1.png");
  cv::Mat labels = cv::Mat::zeros(40, 60, CV_8U);
  labels(cv::Rect(5, 5, 10, 10)).setTo(2);
  labels(cv::Rect(15, 15, 10, 10)).setTo(1);  // touches the crop at a corner only
  labels(cv::Rect(40, 30, 2, 2)).setTo(1);    // too small for an instance
  Masks masks;
  masks.put("IMG_1.png", labels);
  const auto dataset = read_carrot_weed(folder.path(), masks.reader());
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  const AnnotatedImage& image = dataset->images.at(0);
  ASSERT_EQ(image.instances.size(), 2u);
  EXPECT_EQ(image.instances[0].kind, SubClassKind::kWeed);
  EXPECT_EQ(image.instances[0].box_px, cv::Rect(15, 15, 10, 10));
  EXPECT_EQ(image.instances[1].category, "carrot");
  EXPECT_EQ(cv::countNonZero(image.vegetation), 204);

  labels.at<std::uint8_t>(0, 0) = 3;
  const auto unknown = read_carrot_weed(folder.path(), masks.reader());
  ASSERT_FALSE(unknown.ok());
  EXPECT_NE(unknown.error().message.find("label 3"), std::string::npos);
}

TEST(ReadDataset, TellsTheFormatByTheFolder) {
  TemporaryFolder cwfid, carrots, coco, nothing;
  const Masks masks = make_cwfid(cwfid.path(), "annotation: []\n");
  const auto first = read_dataset(cwfid.path(), masks.reader());
  ASSERT_TRUE(first.ok()) << first.error().message;
  EXPECT_EQ(first->name, "cwfid");
  EXPECT_EQ(first->resolution_mm_per_px, 0.11);

  touch(carrots.path() / "images/IMG_1.jpg");
  touch(carrots.path() / "plant_masks/IMG_1.png");
  Masks labels;
  labels.put("IMG_1.png", cv::Mat::zeros(4, 4, CV_8U));
  const auto second = read_dataset(carrots.path(), labels.reader());
  ASSERT_TRUE(second.ok()) << second.error().message;
  EXPECT_EQ(second->name, "carrot_weed");

  ASSERT_TRUE(write_coco(coco.path() / "evaluation.json", {}).ok());
  const auto third = read_dataset(coco.path(), masks.reader());
  ASSERT_TRUE(third.ok()) << third.error().message;
  EXPECT_EQ(third->name, coco.path().filename().string());
  EXPECT_FALSE(third->resolution_mm_per_px.has_value());
  EXPECT_EQ(read_dataset(coco.path() / "evaluation.json", masks.reader())->name, "evaluation");

  EXPECT_EQ(read_dataset(nothing.path(), masks.reader()).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(read_dataset(nothing.path() / "none", masks.reader()).error().code,
            ErrorCode::kNotFound);
}

}  // namespace
}  // namespace furrow::annotation
