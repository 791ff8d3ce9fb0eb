#include "../src/field_import.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"

namespace furrow::cli {
namespace {

constexpr const char* kCoco = R"({
  "images": [{"id": 1, "file_name": "a.png", "width": 1000, "height": 2000}],
  "categories": [{"id": 1, "name": "crop"}, {"id": 2, "name": "Cirsium"}],
  "annotations": [
    {"id": 1, "image_id": 1, "category_id": 1,
     "segmentation": [[480,980, 520,980, 520,1020, 480,1020]]},
    {"id": 2, "image_id": 1, "category_id": 2,
     "segmentation": [[90,1890, 110,1890, 110,1910, 90,1910]]}]})";

class FieldImport : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("field_import_" +
               std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name, const std::string& text) {
    EXPECT_TRUE(write_file_atomically(folder_ / name, text).ok());
    return (folder_ / name).string();
  }

  /// One image of two drawn plants: a crop of 41 x 41 px about (100, 50), a weed of 11 x 11 about
  /// (20, 150).
  std::string cwfid() {
    for (const char* part : {"images", "masks", "annotations"}) {
      std::filesystem::create_directories(folder_ / part);
    }
    cv::Mat mask(200, 200, CV_8UC1, cv::Scalar(255));
    cv::rectangle(mask, {80, 30}, {120, 70}, cv::Scalar(0), cv::FILLED);
    cv::rectangle(mask, {15, 145}, {25, 155}, cv::Scalar(0), cv::FILLED);
    cv::imwrite((folder_ / "masks" / "001_mask.png").string(), mask);
    cv::imwrite((folder_ / "images" / "001_image.png").string(), cv::Mat(200, 200, CV_8UC3));
    file("annotations/001_annotation.yaml",
         "filename: 001_image.png\nannotation:\n"
         "- type: crop\n  points: {x: [70, 130, 130, 70], y: [20, 20, 80, 80]}\n"
         "- type: weed\n  points: {x: [10, 30, 30, 10], y: [140, 140, 160, 160]}\n");
    return folder_.string();
  }

  std::filesystem::path folder_;
};

TEST_F(FieldImport, CocoLiesAlongTheRow) {
  ImportOptions options;
  options.files = {file("a.json", kCoco)};
  options.categories.insert(parse_category("Cirsium=weed:thistle"));
  const field::FieldModel field = import_field(options).field;
  EXPECT_NEAR(field.length_m, 2.0, 1e-9);
  EXPECT_NEAR(field.width_m, 1.0, 1e-9);
  ASSERT_EQ(field.plants.size(), 2U);
  // Upwards is the travel: the weed near the lower edge comes first, left of the middle.
  EXPECT_EQ(field.plants[0].species, "thistle");
  EXPECT_NEAR(field.plants[0].p_F_m.x(), 0.1, 2e-3);
  EXPECT_NEAR(field.plants[0].p_F_m.y(), 0.4, 2e-3);
  EXPECT_EQ(field.plants[1].kind, field::PlantKind::kCrop);
  EXPECT_NEAR(field.plants[1].area_mm2, 1600.0, 1e-6);
  EXPECT_EQ(field.source, "imported: a.json");
}

TEST_F(FieldImport, CocoCoordinatesBeginAtTheImagesCorner) {
  ImportOptions options;
  options.files = {file("a.json", kCoco)};
  options.categories.insert(parse_category("Cirsium=weed"));
  const field::FieldModel field = import_field(options).field;
  // The square from 480 to 520 of 1000 is the middle of the image, and so of the field.
  EXPECT_NEAR(field.plants[1].p_F_m.y(), 0.0, 1e-9);
  EXPECT_NEAR(field.plants[1].p_F_m.x(), 1.0, 1e-9);
}

TEST_F(FieldImport, BadAnnotationsAreLeftOutAndNamed) {
  const std::string text = R"({
    "images": [{"id": 1, "file_name": "a.jpg", "width": 640, "height": 480}],
    "categories": [{"id": 1, "name": "crop"}, {"id": 2, "name": "weed"}],
    "annotations": [
      {"image_id": 1, "category_id": 1, "segmentation": [[26, 31, 50, 31]]},
      {"image_id": 1, "category_id": 1, "segmentation": [], "bbox": [10, 10, 20, 20]},
      {"image_id": 1, "category_id": 2, "iscrowd": 1,
       "segmentation": {"size": [480, 640], "counts": [100, 10, 307090]}},
      {"image_id": 1, "category_id": 2, "segmentation": [[50, 50, 70, 50, 70, 70]]}]})";
  ImportOptions options;
  options.files = {file("a.json", text)};
  const ImportedField imported = import_field(options);
  EXPECT_EQ(imported.field.plants.size(), 2U);
  ASSERT_EQ(imported.notes.size(), 3U);
  EXPECT_NE(imported.notes[0].find("1 of 4 annotations skipped"), std::string::npos);
  EXPECT_NE(imported.notes[1].find("1 of 4 annotations have a box only"), std::string::npos);
  EXPECT_NE(imported.notes[2].find("1 regions to ignore"), std::string::npos);
  options.strict = true;
  EXPECT_THROW((void)import_field(options), ConfigError);
}

TEST_F(FieldImport, CwfidMasksBecomePlants) {
  ImportOptions options;
  options.files = {cwfid()};
  options.layout.ground_resolution_mm_per_px = 2.0;
  const field::FieldModel field = import_field(options).field;
  EXPECT_NEAR(field.length_m, 0.4, 1e-9);
  ASSERT_EQ(field.plants.size(), 2U);
  EXPECT_EQ(field.plants[0].kind, field::PlantKind::kWeed);
  EXPECT_NEAR(field.plants[0].p_F_m.x(), 2e-3 * 49.5, 2e-3);
  EXPECT_NEAR(field.plants[1].p_F_m.x(), 2e-3 * 149.5, 2e-3);
  EXPECT_NEAR(field.plants[1].p_F_m.y(), 0.0, 2e-3);
  EXPECT_NEAR(field.plants[1].area_mm2, 41.0 * 41.0 * 4.0, 1e-6);
}

TEST_F(FieldImport, FilesFollowOneAnother) {
  const std::string csv = file("p.csv",
                               "# length_m: 2\n# width_m: 1\nid,kind,x_m,y_m\n"
                               "3,weed,0.5,0.1\n8,crop,1.5,0\n");
  ImportOptions options;
  options.files = {csv, csv};
  options.layout.gap_m = 0.25;
  const field::FieldModel field = import_field(options).field;
  EXPECT_NEAR(field.length_m, 4.25, 1e-9);
  ASSERT_EQ(field.plants.size(), 4U);
  EXPECT_NEAR(field.plants[2].p_F_m.x(), 2.75, 1e-9);
  EXPECT_EQ(field.plants[3].id, 10);
}

TEST_F(FieldImport, ErrorsNameTheFile) {
  const auto message = [](const std::string& name) {
    ImportOptions options;
    options.files = {name};
    try {
      (void)import_field(options);
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_NE(message((folder_ / "none.csv").string()).find("none.csv"), std::string::npos);
  EXPECT_NE(message(file("a.txt", "x")).find("a.txt"), std::string::npos);
  EXPECT_NE(message(file("a.json", kCoco)).find("Cirsium"), std::string::npos);
  EXPECT_NE(message(file("b.json", "{\"images\":")).find("b.json"), std::string::npos);
  EXPECT_NE(message(file("b.csv", "kind,x_m,y_m\nweed,nan,0\n")).find("b.csv:2"),
            std::string::npos);
  EXPECT_NE(
      message(file("w.geojson", R"({"type":"FeatureCollection","features":[]})")).find("w.geojson"),
      std::string::npos);
  EXPECT_NE(message(folder_.string()).find("annotations"), std::string::npos);
  EXPECT_NE(message(file("c.json", kCoco)).find("--category"), std::string::npos);
}

TEST(Category, IsNameKindAndSpecies) {
  EXPECT_EQ(parse_category("Beta vulgaris=crop").second.kind, field::PlantKind::kCrop);
  EXPECT_EQ(parse_category("a=weed:thistle").second.species, "thistle");
  for (const char* bad : {"", "a", "=weed", "a=", "a=tree", "a:weed"}) {
    EXPECT_THROW((void)parse_category(bad), ConfigError) << bad;
  }
}

}  // namespace
}  // namespace furrow::cli
