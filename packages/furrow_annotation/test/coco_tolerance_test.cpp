// Files as other tools write them: what is read, what is left out and counted, what is refused.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "furrow_annotation/coco.hpp"
#include "furrow_core/file.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"

namespace furrow::annotation {
namespace {

/// One image of 20 x 10 px, the category 3 "beet" (crop) with keypoints "tip" and "stem".
std::string coco(const std::string& annotations, const std::string& image_members = "") {
  return R"({"images": [{"id": 7, "file_name": "a.png", "width": 20, "height": 10)" +
         image_members + R"(}],
    "categories": [{"id": 3, "name": "beet", "supercategory": "crop", "keypoints": ["tip", "stem"]},
                   {"id": 4, "name": "Cirsium", "supercategory": "none"},
                   {"id": 0, "name": "weed"}],
    "annotations": [)" +
         annotations + "]}";
}

std::string beet(const std::string& members) {
  return R"({"image_id": 7, "category_id": 3, )" + members + "}";
}

class CocoTolerance : public testing::Test {
 protected:
  Result<Dataset> read(const std::string& text, const CocoOptions& options = {}) {
    const auto file = folder_.path() / "set.json";
    EXPECT_TRUE(write_file_atomically(file, text).ok());
    return read_coco(file, options);
  }
  /// The instances of a file that must be readable.
  std::vector<AnnotatedInstance> instances(const std::string& annotations) {
    const auto dataset = read(coco(annotations));
    EXPECT_TRUE(dataset.ok()) << dataset.error().message;
    return dataset.ok() ? dataset->images.at(0).instances : std::vector<AnnotatedInstance>{};
  }
  TemporaryFolder folder_;
};

TEST_F(CocoTolerance, PolygonsAreMeasuredFromTheImagesCorner) {
  // Columns 4 to 9, rows 2 to 5: the edges 4 and 10, 2 and 6 lie between pixels.
  const auto found = instances(beet(R"("segmentation": [[4, 2, 10, 2, 10, 6, 4, 6]])"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].box_px, cv::Rect(4, 2, 6, 4));
  EXPECT_EQ(cv::countNonZero(found[0].mask), 24);
}

TEST_F(CocoTolerance, SeveralPolygonsOfOneAnnotationAreUnited) {
  const auto found =
      instances(beet(R"("segmentation": [[0, 0, 4, 0, 4, 4, 0, 4], [2, 2, 6, 2, 6, 6, 2, 6]])"));
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].box_px, cv::Rect(0, 0, 6, 6));
  EXPECT_EQ(cv::countNonZero(found[0].mask), 16 + 16 - 4);
}

TEST_F(CocoTolerance, RunLengthsArePlainOrCompressed) {
  // "5T35N" stands for 5, 100, 5, 98: 208 pixels; of 200 pixels: 5, 100, 95 is "5T3o2".
  const auto plain =
      instances(beet(R"("segmentation": {"size": [10, 20], "counts": [5, 100, 95]})"));
  const auto compressed =
      instances(beet(R"("segmentation": {"size": [10, 20], "counts": "5T3o2"})"));
  ASSERT_EQ(plain.size(), 1u);
  ASSERT_EQ(compressed.size(), 1u);
  EXPECT_EQ(cv::countNonZero(plain[0].mask), 100);
  EXPECT_EQ(plain[0].box_px, cv::Rect(0, 0, 11, 10));
  EXPECT_EQ(compressed[0].box_px, plain[0].box_px);
  EXPECT_EQ(cv::countNonZero(compressed[0].mask != plain[0].mask), 0);
}

TEST_F(CocoTolerance, TheStemIsTheKeypointOfThatName) {
  const std::string square = R"("segmentation": [[4, 2, 10, 2, 10, 6, 4, 6]], )";
  const auto found = instances(beet(square + R"("keypoints": [1, 1, 2, 6.5, 4, 1])") + "," +
                               beet(square + R"("keypoints": [1, 1, 2, 0, 0, 0])"));
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(*found[0].stem_px, Eigen::Vector2d(6.5, 4.0));  // a pixel index: no half pixel between
  EXPECT_FALSE(found[1].stem_px.has_value());               // not labelled
}

TEST_F(CocoTolerance, KeypointsWithoutAStemsNameAreCounted) {
  const auto dataset = read(coco(R"({"image_id": 7, "category_id": 0, "keypoints": [6, 4, 2],
                                     "segmentation": [[4, 2, 10, 2, 10, 6]]})"));
  ASSERT_TRUE(dataset.ok());
  EXPECT_FALSE(dataset->images[0].instances.at(0).stem_px.has_value());
  EXPECT_EQ(dataset->report.without_stem_keypoint, 1u);
}

TEST_F(CocoTolerance, WithoutASegmentationTheBoxIsTheMask) {
  for (const std::string none : {"", R"("segmentation": [], )", R"("segmentation": null, )"}) {
    const auto dataset = read(coco(beet(none + R"("bbox": [4, 2, 6, 4])")));
    ASSERT_TRUE(dataset.ok()) << dataset.error().message;
    ASSERT_EQ(dataset->images[0].instances.size(), 1u) << none;
    const AnnotatedInstance& instance = dataset->images[0].instances[0];
    EXPECT_TRUE(instance.box_only);
    EXPECT_EQ(instance.box_px, cv::Rect(4, 2, 6, 4));
    EXPECT_EQ(cv::countNonZero(instance.mask), 24);
    EXPECT_EQ(dataset->report.box_only, 1u);
  }
}

TEST_F(CocoTolerance, CrowdsAreRegionsToIgnore) {
  const auto dataset =
      read(coco(beet(R"("segmentation": {"size": [10, 20], "counts": [10, 10, 180]},
                                         "iscrowd": 1)")));
  ASSERT_TRUE(dataset.ok());
  EXPECT_TRUE(dataset->images[0].instances.at(0).crowd);
  EXPECT_EQ(dataset->report.ignore_regions, 1u);
}

TEST_F(CocoTolerance, ReadsResolutionIgnoreBoxesAndAttributes) {
  std::string text = coco(beet(R"("bbox": [4, 2, 6, 4], "attributes": {"truncated": true})"),
                          R"(, "resolution_mm_per_px": 0.25, "ignore_boxes": [[-2, 3, 5, 50]])");
  text.insert(1, R"("info": {"resolution_mm_per_px": 1.5}, )");
  const auto dataset = read(text);
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  EXPECT_EQ(dataset->resolution_mm_per_px, 1.5);
  EXPECT_EQ(dataset->images[0].resolution_mm_per_px, 0.25);
  EXPECT_EQ(dataset->images[0].ignore_boxes, std::vector<cv::Rect>({{0, 3, 3, 7}}));
  EXPECT_TRUE(dataset->images[0].instances.at(0).truncated);
}

TEST_F(CocoTolerance, BadAnnotationsAreLeftOutAndCounted) {
  const std::string good = beet(R"("segmentation": [[4, 2, 10, 2, 10, 6, 4, 6]])");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"{}", "annotations[0].image_id: is missing"},
      {R"({"image_id": 8, "category_id": 3})", "annotations[0].image_id: names no image"},
      {R"({"image_id": 7, "category_id": 9})", "annotations[0].category_id: names no category"},
      {beet(R"("id": 1)"), "annotations[0]: neither a segmentation nor a box"},
      {beet(R"("segmentation": [[6, 1, 9, 1]])"),
       "annotations[0].segmentation[0]: polygon of fewer than three corners"},
      {beet(R"("segmentation": [[1, 2, 3, 4, 5]])"), "polygon of an odd number of coordinates"},
      {beet(R"("segmentation": [[1, 2, 3, 4, "x", 6]])"),
       "annotations[0].segmentation[0][4]: is not a number"},
      {beet(R"("segmentation": [[1, 2, 3, 4, 1e9, 6]])"), "coordinate outside"},
      {beet(R"("segmentation": [[30, 2, 40, 2, 40, 6]])"), "no pixel of the image inside"},
      {beet(R"("segmentation": [[4, 2, 10, 2, 7, 2]])"), "no pixel of the image inside"},
      {beet(R"("segmentation": {"size": [20, 10], "counts": [200]})"),
       "annotations[0].segmentation.size: is not the image's [height, width]"},
      {beet(R"("segmentation": {"size": [10, 20], "counts": "5"})"), "do not cover the image"},
      {beet(R"("segmentation": {"size": [10, 20], "counts": "T"})"), "end within a number"},
      {beet(R"("segmentation": {"size": [10, 20], "counts": [-5, 205]})"), "is out of range"},
      {beet(R"("segmentation": {"size": [10, 20], "counts": [200]})"),
       "no pixel of the image inside"},
      {beet(R"("bbox": [4, 2, 0, 4])"), "no pixel of the image inside"},
      {beet(R"("bbox": [4, 2, -6, 4])"), "box of a negative size"},
      {beet(R"("bbox": [4, 2, 6])"), "is not [x, y, width, height]"},
      {beet(R"("bbox": [4, 2, 6, 4], "keypoints": [1, 1, 2])"), "fewer keypoints"},
      {beet(R"("bbox": [4, 2, 6, 4], "iscrowd": "no")"), "annotations[0].iscrowd: is not"},
      {"5", "annotations[0].image_id: is missing"}};
  for (const auto& [bad, expected] : cases) {
    const auto dataset = read(coco(bad + "," + good));
    ASSERT_TRUE(dataset.ok()) << bad << dataset.error().message;
    EXPECT_EQ(dataset->images[0].instances.size(), 1u) << bad;
    EXPECT_EQ(dataset->report.annotations, 2u);
    EXPECT_EQ(dataset->report.skipped_count(), 1u) << bad;

    const auto strict = read(coco(bad + "," + good), {.strict = true});
    ASSERT_FALSE(strict.ok()) << bad;
    EXPECT_EQ(strict.error().code, ErrorCode::kParse);
    EXPECT_NE(strict.error().message.find("set.json: annotations[0]"), std::string::npos);
    EXPECT_NE(strict.error().message.find(expected), std::string::npos) << strict.error().message;
  }
}

TEST_F(CocoTolerance, DegeneratePartsBesideGoodOnesAreLeftOut) {
  const std::string text =
      coco(beet(R"("segmentation": [[6, 1, 9, 1], [4, 2, 10, 2, 10, 6, 4, 6]])"));
  const auto dataset = read(text);
  ASSERT_TRUE(dataset.ok());
  EXPECT_EQ(dataset->images[0].instances.at(0).box_px, cv::Rect(4, 2, 6, 4));
  EXPECT_EQ(dataset->report.skipped_count(), 1u);
  EXPECT_FALSE(read(text, {.strict = true}).ok());
}

TEST_F(CocoTolerance, TheReportNamesCountReasonAndFirstEntry) {
  const auto dataset =
      read(coco(beet(R"("segmentation": [[6, 1, 9, 1]])") + "," +
                beet(R"("segmentation": [[6, 1, 9, 1]])") + "," + beet(R"("bbox": [4, 2, 6, 4])")));
  ASSERT_TRUE(dataset.ok());
  const auto lines = describe(dataset->report, "set.json");
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0],
            "set.json: 2 of 3 annotations skipped: polygon of fewer than three corners (first: "
            "annotations[0].segmentation[0])");
  EXPECT_EQ(lines[1], "set.json: 1 of 3 annotations have a box only: the box is taken as the mask");
  EXPECT_TRUE(describe(ReadReport{}, "set.json").empty());
}

TEST_F(CocoTolerance, KindComesFromOptionThenSupercategoryThenName) {
  const std::string box = R"("bbox": [4, 2, 6, 4]})";
  const std::string text = coco(R"({"image_id": 7, "category_id": 4, )" + box +
                                R"(, {"image_id": 7, "category_id": 0, )" + box + ", " +
                                beet(R"("bbox": [4, 2, 6, 4])"));
  const auto dataset = read(text);
  ASSERT_TRUE(dataset.ok());
  const auto& found = dataset->images[0].instances;
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0].kind, SubClassKind::kWeed);  // assumed, and said
  EXPECT_EQ(found[1].kind, SubClassKind::kWeed);
  EXPECT_EQ(found[2].kind, SubClassKind::kCrop);
  EXPECT_EQ(dataset->report.assumed_weeds, std::vector<std::string>{"Cirsium"});

  const auto told = read(text, {.kinds = {{"Cirsium", SubClassKind::kCrop}}});
  ASSERT_TRUE(told.ok());
  EXPECT_EQ(told->images[0].instances[0].kind, SubClassKind::kCrop);
  EXPECT_TRUE(told->report.assumed_weeds.empty());

  const auto refused = read(text, {.unknown_kind = UnknownKind::kRefuse});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().code, ErrorCode::kNotFound);
  EXPECT_NE(refused.error().message.find("'Cirsium'"), std::string::npos);
}

TEST_F(CocoTolerance, AMalformedFileIsRefusedWithFileAndKey) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"{\"images\": [", "parse error"},
      {"[]", "categories: is missing"},
      {"{\"categories\": 5}", "categories: is not a list"},
      {R"({"categories": [{"id": 1, "name": "a"}, {"id": 1, "name": "b"}]})", "given twice"},
      {R"({"categories": [], "images": [{"id": 1, "width": 9, "height": 1}]})",
       "images[0].file_name: is missing"},
      {R"({"categories": [], "images": [{"id": 1, "file_name": "a", "width": 999999, "height": 1}]})",
       "images[0].width: is out of range"},
      {R"({"categories": [], "images": [], "annotations": [], "resolution_mm_per_px": 0})",
       "resolution_mm_per_px: is not in (0, 1000] mm"}};
  for (const auto& [text, expected] : cases) {
    const auto dataset = read(text);
    ASSERT_FALSE(dataset.ok()) << text;
    EXPECT_NE(dataset.error().message.find("set.json"), std::string::npos);
    EXPECT_NE(dataset.error().message.find(expected), std::string::npos) << dataset.error().message;
  }
  EXPECT_EQ(read_coco(folder_.path() / "none.json").error().code, ErrorCode::kNotFound);
}

TEST_F(CocoTolerance, NumbersWithADecimalPointAreIntegersToo) {
  const auto dataset = read(
      R"({"images": [{"id": 7.0, "file_name": "a", "width": 20.0, "height": 10}],
          "categories": [{"id": 3, "name": "crop"}],
          "annotations": [{"image_id": 7, "category_id": 3.0, "bbox": [4, 2, 6, 4]}]})");
  ASSERT_TRUE(dataset.ok()) << dataset.error().message;
  EXPECT_EQ(dataset->images[0].instances.size(), 1u);
}

}  // namespace
}  // namespace furrow::annotation
