#include <gtest/gtest.h>

#include "furrow_core/file.hpp"
#include "furrow_core/random.hpp"
#include "furrow_vision/coco_rle.hpp"
#include "furrow_vision/dataset_coco.hpp"
#include "temporary_folder.hpp"

namespace furrow::vision {
namespace {

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::countNonZero(a != b) == 0;
}

TEST(RunLengths, RunDownTheColumnsAndStartWithZeros) {
  const cv::Mat mask = (cv::Mat_<std::uint8_t>(2, 3) << 255, 0, 0,  //
                        255, 255, 0);
  EXPECT_EQ(encode_run_lengths(mask), (RunLengths{0, 2, 1, 1, 2}));
}

TEST(RunLengths, ComeBackFromAnyMask) {
  Random random(1);
  for (int round = 0; round < 200; ++round) {
    cv::Mat mask(static_cast<int>(random.integer(1, 40)), static_cast<int>(random.integer(1, 40)),
                 CV_8U);
    const double share = random.uniform();
    for (auto& pixel : cv::Mat_<std::uint8_t>(mask)) pixel = random.bernoulli(share) ? 255 : 0;
    const auto runs = decompress_run_lengths(compress_run_lengths(encode_run_lengths(mask)));
    ASSERT_TRUE(runs.ok());
    const auto back = decode_run_lengths(*runs, mask.size());
    ASSERT_TRUE(back.ok());
    EXPECT_TRUE(same(*back, mask));
  }
}

TEST(RunLengths, CompressAsTheFormSays) {
  // 5 is 00101: one character, 48 + 5. 100 is 00011 00100: low five bits first with the mark 32:
  // 48 + 32 + 4 and 48 + 3. The fourth run stands as the difference to the second: 98 - 100 = -2,
  // 11110: 48 + 30.
  EXPECT_EQ(compress_run_lengths({5, 100, 5, 98}), "5T35N");
  const auto runs = decompress_run_lengths("5T35N");
  ASSERT_TRUE(runs.ok());
  EXPECT_EQ(*runs, (RunLengths{5, 100, 5, 98}));
}

TEST(RunLengths, RefuseWhatIsMalformed) {
  EXPECT_FALSE(decompress_run_lengths("T").ok());  // ends within a number
  EXPECT_FALSE(decompress_run_lengths("5 5").ok());
  EXPECT_FALSE(decompress_run_lengths("ooooooooooooooooooooo0").ok());
  EXPECT_FALSE(decompress_run_lengths("N").ok());  // -2
  EXPECT_FALSE(decode_run_lengths({3, 4}, {2, 2}).ok());
  EXPECT_FALSE(decode_run_lengths({4294967295u, 4294967295u}, {2, 2}).ok());
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
  dataset.images = {before, last};
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
  EXPECT_TRUE(same(last.instances[0].mask, written.images[1].instances[0].mask));
  EXPECT_EQ(*last.instances[0].stem_px, Eigen::Vector2d(5.25, 5.5));
  EXPECT_EQ(last.instances[1].kind, SubClassKind::kCrop);
  EXPECT_FALSE(last.instances[1].stem_px.has_value());
}

std::string coco(const std::string& annotation) {
  return R"({"images": [{"id": 7, "file_name": "a.png", "width": 20, "height": 10}],
    "categories": [{"id": 3, "name": "beet", "supercategory": "crop", "keypoints": ["stem"]}],
    "annotations": [)" +
         annotation + "]}";
}

TEST(Coco, ReadsPolygonsAndPlainRunLengths) {
  TemporaryFolder folder;
  const auto file = folder.path() / "a.json";
  // COCO's corner (4, 2) is that of pixel (4, 2): 6 columns and 5 rows.
  ASSERT_TRUE(write_file_atomically(file, coco(R"({"image_id": 7, "category_id": 3, "iscrowd": 0,
                     "segmentation": [[4.5, 2.5, 9.5, 2.5, 9.5, 6.5, 4.5, 6.5]],
                     "keypoints": [6, 4, 2]},
                    {"image_id": 7, "category_id": 3, "iscrowd": 1,
                     "segmentation": {"size": [10, 20], "counts": [10, 10, 180]}})"))
                  .ok());
  const auto read = read_coco(file);
  ASSERT_TRUE(read.ok()) << read.error().message;
  const auto& instances = read->images.at(0).instances;
  ASSERT_EQ(instances.size(), 2u);
  EXPECT_EQ(instances[0].box_px, cv::Rect(4, 2, 6, 5));
  EXPECT_EQ(cv::countNonZero(instances[0].mask), 30);
  EXPECT_EQ(*instances[0].stem_px, Eigen::Vector2d(6.0, 4.0));
  EXPECT_EQ(instances[1].box_px, cv::Rect(1, 0, 1, 10));
  EXPECT_TRUE(instances[1].crowd);
}

TEST(Coco, NamesFileAndKeyOfWhatIsMalformed) {
  const std::string good = R"("image_id": 7, "category_id": 3)";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"{\"images\": [", "parse error"},
      {"[]", "categories: is missing"},
      {"{\"categories\": 5}", "categories: is not a list"},
      {coco("{}"), "annotations[0].image_id: is missing"},
      {coco(R"({"image_id": 8, "category_id": 3})"), "names no image"},
      {coco(R"({"image_id": 7, "category_id": 4})"), "names no category"},
      {coco("{" + good + "}"), "annotations[0].segmentation: is missing"},
      {coco("{" + good + R"(, "segmentation": [[1, 2, 3, 4]]})"), "three corners"},
      {coco("{" + good + R"(, "segmentation": [[1, 2, 3, 4, "x", 6]]})"),
       "annotations[0].segmentation[0][4]: is not a number"},
      {coco("{" + good + R"(, "segmentation": {"size": [20, 10], "counts": "5"}})"), "size"},
      {coco("{" + good + R"(, "segmentation": {"size": [10, 20], "counts": "5"}})"), "cover 5"},
      {coco("{" + good + R"(, "segmentation": {"size": [10, 20], "counts": [200]}})"),
       "holds no pixel"},
      {R"({"categories": [], "images": [{"id": 1, "file_name": "a", "width": 999999, "height": 1}]})",
       "images[0].width: is out of range"}};
  TemporaryFolder folder;
  const auto file = folder.path() / "bad.json";
  for (const auto& [text, expected] : cases) {
    ASSERT_TRUE(write_file_atomically(file, text).ok());
    const auto read = read_coco(file);
    ASSERT_FALSE(read.ok()) << text;
    EXPECT_NE(read.error().message.find("bad.json"), std::string::npos);
    EXPECT_NE(read.error().message.find(expected), std::string::npos) << read.error().message;
  }
  EXPECT_EQ(read_coco(folder.path() / "none.json").error().code, ErrorCode::kNotFound);
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

TEST(Coco, TakesDetectionsByTheirMostProbableClass) {
  Instance instance;
  instance.class_scores = {0.3, 0.7};
  instance.box_px = {1, 2, 3, 4};
  instance.mask = cv::Mat(4, 3, CV_8U, cv::Scalar(255));
  const auto annotations = to_annotations(
      {instance}, {{"beet", SubClassKind::kCrop}, {"goosefoot", SubClassKind::kWeed}});
  ASSERT_EQ(annotations.size(), 1u);
  EXPECT_EQ(annotations[0].category, "goosefoot");
  EXPECT_EQ(annotations[0].kind, SubClassKind::kWeed);
}

}  // namespace
}  // namespace furrow::vision
