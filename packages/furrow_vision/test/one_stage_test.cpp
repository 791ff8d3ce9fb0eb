#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"
#include "furrow_vision/detector_choice.hpp"
#include "furrow_vision/one_stage_decoding.hpp"
#include "furrow_vision/one_stage_detector.hpp"

namespace furrow::vision {
namespace {

namespace fs = std::filesystem;

const fs::path kData = fs::path(FURROW_TEST_DATA_DIR) / "data";

/// Maps of 20 x 30 cells of soil with two classes.
class Decoding : public testing::Test {
 protected:
  Decoding() {
    for (int i = 0; i < 6; ++i) maps_of_.emplace_back(20, 30, CV_32F, cv::Scalar(0.0));
    maps_ = {maps_of_[0], maps_of_[1], maps_of_[2], maps_of_[3], {maps_of_[4], maps_of_[5]}};
    maps_.plant_logit.setTo(-6.0);
    maps_.stem_logit.setTo(-6.0);
    vegetation_ = cv::Mat::zeros(20, 30, CV_8U);
  }

  /// A plant of cells that all point to its stem, in pixels; `peak` is the logit at its cell.
  void draw(const cv::Rect& cells, const Eigen::Vector2d& stem_px, float peak, float crop_logit) {
    for (int v = cells.y; v < cells.y + cells.height; ++v) {
      for (int u = cells.x; u < cells.x + cells.width; ++u) {
        vegetation_.at<std::uint8_t>(v, u) = 255;
        maps_.plant_logit.at<float>(v, u) = 6.0f;
        maps_.offset_u.at<float>(v, u) = static_cast<float>((stem_px.x() - (4.0 * u + 1.5)) / 32.0);
        maps_.offset_v.at<float>(v, u) = static_cast<float>((stem_px.y() - (4.0 * v + 1.5)) / 32.0);
        maps_.class_logits[0].at<float>(v, u) = crop_logit;
      }
    }
    const int u = static_cast<int>(std::floor((stem_px.x() + 0.5) / 4.0));
    const int v = static_cast<int>(std::floor((stem_px.y() + 0.5) / 4.0));
    if (u >= 0 && v >= 0) maps_.stem_logit.at<float>(v, u) = peak;
  }
  DecodedPlants decode() { return decode_one_stage(maps_, vegetation_, grid_, parameters_); }

  std::vector<cv::Mat> maps_of_;
  OneStageMaps maps_;
  cv::Mat vegetation_;
  CellGrid grid_{4.0, 32.0, 1.0};
  OneStageDecodingParameters parameters_;
};

TEST_F(Decoding, NothingInSoil) {
  const DecodedPlants decoded = decode();
  EXPECT_TRUE(decoded.plants.empty());
  EXPECT_EQ(cv::countNonZero(decoded.labels), 0);
}

TEST_F(Decoding, SeparatesPlantsThatTouch) {
  draw({2, 4, 6, 6}, {18.3, 26.1}, 3.0f, 2.0f);
  draw({8, 4, 6, 6}, {45.2, 28.6}, 2.0f, -2.0f);
  const DecodedPlants decoded = decode();
  ASSERT_EQ(decoded.plants.size(), 2u);
  const DecodedPlant& first = decoded.plants[0];
  const DecodedPlant& second = decoded.plants[1];
  EXPECT_EQ(first.cells, 36);
  EXPECT_EQ(second.cells, 36);
  EXPECT_NEAR((first.stem_px - Eigen::Vector2d(18.3, 26.1)).norm(), 0.0, 1e-3);
  EXPECT_NEAR((second.stem_px - Eigen::Vector2d(45.2, 28.6)).norm(), 0.0, 1e-3);
  EXPECT_NEAR(first.stem_probability, 1.0 / (1.0 + std::exp(-3.0)), 1e-6);
  EXPECT_NEAR(first.plant_probability, 1.0 / (1.0 + std::exp(-6.0)), 1e-6);
  // The second class has a logit of 0 everywhere.
  EXPECT_NEAR(first.class_scores[0], 1.0 / (1.0 + std::exp(-2.0)), 1e-6);
  EXPECT_NEAR(second.class_scores[0], 1.0 / (1.0 + std::exp(2.0)), 1e-6);
  EXPECT_NEAR(first.class_scores[0] + first.class_scores[1], 1.0, 1e-12);
  EXPECT_EQ(decoded.labels.at<int>(4, 7), 1);
  EXPECT_EQ(decoded.labels.at<int>(4, 8), 2);
}

TEST_F(Decoding, PlantWithoutPeakIsOneOfItsOwn) {
  draw({2, 4, 6, 6}, {-9.0, 26.0}, 0.0f, 1.0f);  // its stem is outside
  const DecodedPlants decoded = decode();
  ASSERT_EQ(decoded.plants.size(), 1u);
  EXPECT_NEAR(decoded.plants[0].stem_px.x(), -9.0, 1e-3);
  EXPECT_EQ(decoded.plants[0].cells, 36);
  EXPECT_LT(decoded.plants[0].stem_probability, 0.01);
}

TEST_F(Decoding, StrayCellsGoToThePlantThatTheyTouch) {
  draw({2, 4, 6, 6}, {18.0, 26.0}, 3.0f, 1.0f);
  // One cell, of 16 mm2, that points far away is less than a plant.
  parameters_.min_plant_area_mm2 = 20.0;
  vegetation_.at<std::uint8_t>(4, 8) = 255;
  maps_.offset_u.at<float>(4, 8) = 2.5f;
  const DecodedPlants decoded = decode();
  ASSERT_EQ(decoded.plants.size(), 1u);
  EXPECT_EQ(decoded.plants[0].cells, 37);
}

TEST_F(Decoding, AStemBelowTheLeavesOfAnotherPlantIsAPlant) {
  draw({2, 4, 10, 6}, {17.5, 29.5}, 3.0f, 2.0f);
  maps_.stem_logit.at<float>(6, 10) = 1.0f;   // its cell votes for the other one
  maps_.stem_logit.at<float>(15, 25) = 1.0f;  // in soil
  parameters_.vote_radius_mm = 4.0;
  parameters_.vote_radius_factor = 0.0;
  const DecodedPlants decoded = decode();
  ASSERT_EQ(decoded.plants.size(), 2u);
  EXPECT_EQ(decoded.plants[0].cells, 59);
  EXPECT_EQ(decoded.plants[1].cells, 1);
  EXPECT_EQ(decoded.labels.at<int>(6, 10), 2);
  EXPECT_NEAR(decoded.plants[1].stem_probability, 1.0 / (1.0 + std::exp(-1.0)), 1e-6);
}

TEST_F(Decoding, SpecksAreDropped) {
  vegetation_.at<std::uint8_t>(10, 20) = 255;
  parameters_.min_plant_area_mm2 = 17.0;  // a cell is 16 mm2
  EXPECT_TRUE(decode().plants.empty());
  parameters_.min_plant_area_mm2 = 16.0;
  EXPECT_EQ(decode().plants.size(), 1u);
}

TEST_F(Decoding, AStemSpeaksForItsPlant) {
  // A seedling of two cells: its stem is seen, of its leaves the network is undecided.
  draw({4, 4, 2, 1}, {17.5, 17.5}, 2.0f, -2.0f);
  maps_.plant_logit(cv::Rect(4, 4, 2, 1)).setTo(-1.0);
  parameters_.min_plant_area_mm2 = 0.0;
  parameters_.stem_evidence = 1.5;
  const cv::Mat evidence = plant_evidence(maps_, parameters_);
  EXPECT_FLOAT_EQ(evidence.at<float>(4, 4), 3.5f);
  EXPECT_FLOAT_EQ(evidence.at<float>(4, 5), -1.0f);
  EXPECT_FLOAT_EQ(evidence.at<float>(0, 0), -4.5f);  // soil
  const DecodedPlants decoded = decode();
  ASSERT_EQ(decoded.plants.size(), 1u);
  const double expected = 0.5 / (1.0 + std::exp(-3.5)) + 0.5 / (1.0 + std::exp(1.0));
  EXPECT_NEAR(decoded.plants[0].plant_probability, expected, 1e-6);
}

TEST_F(Decoding, KeepsTheStrongerOfTwoStemsThatAreTooNear) {
  maps_.stem_logit.at<float>(5, 5) = 1.0f;
  maps_.stem_logit.at<float>(5, 8) = 2.0f;  // 12 px, 12 mm
  parameters_.stem_separation_mm = 12.5;
  const auto stems = find_stems(maps_, grid_, parameters_);
  ASSERT_EQ(stems.size(), 1u);
  EXPECT_NEAR(stems[0].stem_px.x(), 8 * 4 + 1.5, 1e-6);
  parameters_.stem_separation_mm = 11.5;
  EXPECT_EQ(find_stems(maps_, grid_, parameters_).size(), 2u);
}

TEST_F(Decoding, ManyPeaksAreBounded) {
  maps_.stem_logit.setTo(5.0);
  parameters_.stem_separation_mm = 0.0;
  EXPECT_EQ(find_stems(maps_, grid_, parameters_).size(), 600u);
}

TEST(SplitOutput, RefusesOtherShapesAndValues) {
  const int shape[] = {1, 6, 3, 5};
  cv::Mat output(4, shape, CV_32F, cv::Scalar(0.5));
  const auto good = split_one_stage_output(output, 2);
  ASSERT_TRUE(good.ok());
  EXPECT_EQ(good->class_logits.size(), 2u);
  EXPECT_EQ(good->plant_logit.size(), cv::Size(5, 3));
  const auto other = split_one_stage_output(output, 3);
  ASSERT_FALSE(other.ok());
  EXPECT_NE(other.error().message.find("other classes"), std::string::npos);
  EXPECT_FALSE(split_one_stage_output(cv::Mat(3, 5, CV_32F), 2).ok());
  output.ptr<float>()[17] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(split_one_stage_output(output, 2).ok());
}

/// The network that test/data/make_one_stage.py makes: at 2 mm a pixel, cells of 4.
class OneStage : public testing::Test {
 protected:
  // 500 px at 1 m is 2 mm a pixel: the model's own resolution.
  geometry::PinholeCamera camera_{{192, 128, 500.0, 500.0, 95.5, 63.5}};
  cv::Mat bgr_ = cv::Mat(128, 192, CV_8UC3, cv::Scalar(60, 70, 80));
  cv::Mat none_;
  OneStageDetector detector_{{}, kData / "one_stage.yaml"};

  /// A disc of green with a blue cell at the stem.
  void draw(cv::Point stem, int radius, bool crop) {
    cv::circle(bgr_, stem, radius, cv::Scalar(40, 200, crop ? 120 : 10), -1);
    cv::rectangle(bgr_, cv::Rect(stem.x - 2, stem.y - 2, 4, 4),
                  cv::Scalar(255, 255, crop ? 150 : 0), -1);
  }
};

TEST_F(OneStage, FindsPlantsOnSoil) {
  draw({50, 62}, 12, true);
  draw({130, 38}, 8, false);
  const auto found = detector_.detect({bgr_, none_, camera_, 1.0});
  ASSERT_TRUE(found.ok()) << found.error().message;
  ASSERT_EQ(found->size(), 2u);
  for (const Instance& plant : *found) {
    const bool crop = plant.stem_px.x() < 90.0;
    const Eigen::Vector2d stem = crop ? Eigen::Vector2d(49.5, 61.5) : Eigen::Vector2d(129.5, 37.5);
    EXPECT_LT((plant.stem_px - stem).norm(), 4.0) << plant.stem_px.transpose();
    EXPECT_EQ(plant.crop_probability > 0.5, crop);
    cv::Mat painted;
    cv::inRange(bgr_, cv::Scalar(40, 200, crop ? 120 : 10), cv::Scalar(40, 200, crop ? 120 : 10),
                painted);
    EXPECT_NEAR(plant.area_mm2 / (4.0 * cv::countNonZero(painted)), 1.0, 0.1);
    EXPECT_GT(plant.score, 0.3);
    EXPECT_FALSE(plant.depth_measured);
  }
  EXPECT_EQ(detector_.classes()[1].name, "goosefoot");
}

TEST_F(OneStage, ScalesToTheModelsResolution) {
  draw({50, 62}, 12, true);
  cv::Mat fine;
  cv::resize(bgr_, fine, {}, 2.0, 2.0, cv::INTER_NEAREST);
  const geometry::PinholeCamera camera({384, 256, 1000.0, 1000.0, 191.5, 127.5});
  const auto coarse = detector_.detect({bgr_, none_, camera_, 1.0});
  const auto found = detector_.detect({fine, none_, camera, 1.0});
  ASSERT_TRUE(coarse.ok() && found.ok());
  ASSERT_EQ(coarse->size(), 1u);
  ASSERT_EQ(found->size(), 1u);
  // The centre of pixel u becomes 2 u + 0.5.
  EXPECT_NEAR(found->front().stem_px.x(), 2.0 * coarse->front().stem_px.x() + 0.5, 1.0);
  EXPECT_NEAR(found->front().area_mm2 / coarse->front().area_mm2, 1.0, 0.05);
}

TEST_F(OneStage, StemStandsOnTheGround) {
  draw({50, 62}, 12, true);
  cv::Mat depth(128, 192, CV_32F, cv::Scalar(1.0));
  cv::circle(depth, {50, 62}, 12, cv::Scalar(0.9), -1);
  depth.row(60).setTo(std::numeric_limits<float>::quiet_NaN());  // holes
  const auto found = detector_.detect({bgr_, depth, camera_, 1.0});
  ASSERT_TRUE(found.ok());
  ASSERT_EQ(found->size(), 1u);
  EXPECT_TRUE(found->front().depth_measured);
  EXPECT_NEAR(found->front().stem_depth_m, 1.0, 1e-6);
  const auto flat = detector_.detect({bgr_, none_, camera_, 0.9});
  ASSERT_TRUE(flat.ok());
  EXPECT_NEAR(found->front().area_mm2 / flat->front().area_mm2, 1.0, 0.02);
}

TEST_F(OneStage, RefusesBadImages) {
  const geometry::PinholeCamera small({32, 24, 500.0, 500.0, 15.5, 11.5});
  const auto error = [&](const cv::Mat& bgr, const cv::Mat& depth) {
    const auto found = detector_.detect({bgr, depth, small, 1.0});
    return found.ok() ? std::string() : found.error().message;
  };
  const cv::Mat good(24, 32, CV_8UC3, cv::Scalar(60, 70, 80));
  EXPECT_EQ(error(good, none_), "");
  EXPECT_NE(error(none_, none_), "");
  EXPECT_NE(error(cv::Mat(24, 32, CV_8U), none_), "");
  EXPECT_NE(error(cv::Mat(24, 32, CV_16UC3), none_), "");
  EXPECT_NE(error(good, cv::Mat(24, 31, CV_32F)), "");
}

TEST_F(OneStage, HugeResolutionIsBounded) {
  OneStageParameters parameters;
  parameters.network.input_area_max_px = 4096;
  OneStageDetector bounded(parameters, kData / "one_stage.yaml");
  const auto found = bounded.detect({bgr_, none_, camera_, 1000.0});
  EXPECT_TRUE(found.ok());
}

class ModelFiles : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"one_stage.yaml", "one_stage.onnx"}) {
      const auto content = read_file(kData / name);
      ASSERT_TRUE(content.ok());
      (fs::path(name).extension() == ".yaml" ? yaml_ : onnx_) = *content;
    }
  }
  /// The message of what making a detector of these files throws; empty: nothing.
  std::string fault(const std::string& yaml, const std::string& onnx,
                    const OneStageParameters& parameters = {}) {
    EXPECT_TRUE(write_file_atomically(folder_.path() / "m.yaml", yaml).ok());
    EXPECT_TRUE(write_file_atomically(folder_.path() / "one_stage.onnx", onnx).ok());
    try {
      const OneStageDetector detector(parameters, folder_.path() / "m.yaml");
      return {};
    } catch (const ConfigError& error) {
      return error.what();
    }
  }
  [[nodiscard]] std::string edited(const std::string& from, const std::string& to) const {
    std::string text = yaml_;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
  }
  [[nodiscard]] std::string without_line(const std::string& key) const {
    const auto at = yaml_.find("\n" + key + ":") + 1;
    return yaml_.substr(0, at) + yaml_.substr(yaml_.find('\n', at) + 1);
  }

  TemporaryFolder folder_;
  std::string yaml_, onnx_;
};

TEST_F(ModelFiles, SayWhatIsWrong) {
  EXPECT_EQ(fault(yaml_, onnx_), "");
  const auto says = [&](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  says(fault(yaml_, onnx_.substr(0, 200)), "truncated");
  std::string damaged = onnx_;
  damaged[150] = static_cast<char>(damaged[150] ^ 1);
  says(fault(yaml_, damaged), "SHA-256");
  says(fault("", onnx_), "not a model file");
  says(fault("name: [", onnx_), "not YAML");
  says(fault(yaml_ + "colour: red\n", onnx_), "colour: is not a key");
  says(fault(edited("stride: 4", "stride: four"), onnx_), "m.yaml:6: stride: is not a number");
  says(fault(edited("stride: 4", "stride: 400"), onnx_), "out of range");
  says(fault(edited("stride: 4", "stride: 8"), onnx_), "stride");
  says(fault(edited("px: 2.0", "px: .nan"), onnx_), "out of range");
  says(fault(without_line("stride"), onnx_), "stride: is missing");
  says(fault(edited("kind: weed", "kind: tree"), onnx_), "not crop or weed");
  says(fault(edited("goosefoot", "beet"), onnx_), "stands twice");
  says(fault(yaml_ + "  - {name: thistle, kind: weed}\n", onnx_), "other classes");
  says(fault(edited("one_stage.onnx", "none.onnx"), onnx_), "none.onnx");
  says(fault(edited("name:", "kind: mask_rcnn\nname:"), onnx_), "network: is not a key");
  OneStageParameters parameters;
  parameters.network.classes = {"beet", "thistle"};
  says(fault(yaml_, onnx_, parameters), "has the classes beet, goosefoot, not beet, thistle");
  parameters.network.classes = {"beet", "goosefoot"};
  EXPECT_EQ(fault(yaml_, onnx_, parameters), "");
}

TEST_F(ModelFiles, CropsMayWeighMore) {
  EXPECT_NE(fault("crop_log_odds: 11\n" + yaml_, onnx_).find("out of range"), std::string::npos);
  cv::Mat bgr(128, 192, CV_8UC3, cv::Scalar(20, 30, 45));
  cv::circle(bgr, {50, 62}, 12, cv::Scalar(40, 200, 60), -1);
  const geometry::PinholeCamera camera({192, 128, 500.0, 500.0, 95.5, 63.5});
  const auto log_odds = [&](const std::string& yaml, const OneStageParameters& parameters) {
    EXPECT_EQ(fault(yaml, onnx_), "");
    OneStageDetector detector(parameters, folder_.path() / "m.yaml");
    const auto found = detector.detect({bgr, cv::Mat(), camera, 1.0});
    EXPECT_TRUE(found.ok() && found->size() == 1);
    const double crop = found->at(0).crop_probability;
    return std::log(crop / (1.0 - crop));
  };
  OneStageParameters parameters;
  parameters.context.class_evidence = "learned";
  const double plain = log_odds(yaml_, parameters);
  const std::string with_odds = "crop_log_odds: 1.5\n" + yaml_;
  EXPECT_NEAR(log_odds(with_odds, parameters), plain + 1.5, 1e-6);
  parameters.network.crop_log_odds = -0.5;
  EXPECT_NEAR(log_odds(with_odds, parameters), plain + 1.0, 1e-6);
}

TEST_F(ModelFiles, WhatIsNoNetworkIsRefused) {
  std::string rubbish(353, 'x');
  const std::string size_only = without_line("network_sha256");
  const std::string message = fault(size_only, rubbish);
  EXPECT_NE(message.find("no network"), std::string::npos) << message;
}

TEST_F(ModelFiles, DetectorChoiceNeedsOne) {
  DetectorParameters parameters;
  EXPECT_EQ(make_detector(parameters)->classes().size(), 2u);
  parameters.detector = "one_stage";
  EXPECT_THROW((void)make_detector(parameters), ConfigError);
  parameters.model_file = (kData / "one_stage.yaml").string();
  EXPECT_EQ(make_detector(parameters)->classes()[0].name, "beet");
}

}  // namespace
}  // namespace furrow::vision
