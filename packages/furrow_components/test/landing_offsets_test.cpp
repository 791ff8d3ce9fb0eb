#include "furrow_components/landing_offsets.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "furrow_core/error.hpp"

namespace furrow::components {
namespace {

class LandingOffsetsFile : public testing::Test {
 protected:
  LandingOffsets load(const std::string& text) {
    std::ofstream(path_) << text;
    return load_landing_offsets(path_);
  }
  void expect_refused(const std::string& text, const std::string& part) {
    try {
      (void)load(text);
      FAIL() << "taken: " << text;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }
  ~LandingOffsetsFile() override { std::filesystem::remove(path_); }

  std::filesystem::path path_ = testing::TempDir() + "furrow_landing_offsets.csv";
};

constexpr char kHeader[] = "axis,speed_mps,along_mm,across_mm\n";

TEST_F(LandingOffsetsFile, IsReadByAxisInMeters) {
  const auto offsets = load(kHeader + std::string("axis_1,0.5,10,-2.5\r\n"
                                                  "axis_2,0.3,0,0\n\n"
                                                  "axis_1,0.9,18.5,-2"));
  ASSERT_EQ(offsets.size(), 2u);
  ASSERT_EQ(offsets.at("axis_1").size(), 2u);
  EXPECT_EQ(offsets.at("axis_1")[0].speed_mps, 0.5);
  EXPECT_NEAR(offsets.at("axis_1")[0].offset_m.x(), 0.010, 1e-15);
  EXPECT_NEAR(offsets.at("axis_1")[0].offset_m.y(), -0.0025, 1e-15);
  EXPECT_NEAR(offsets.at("axis_1")[1].offset_m.x(), 0.0185, 1e-15);
  EXPECT_TRUE(load(kHeader).empty());
}

TEST_F(LandingOffsetsFile, MalformedFileIsAnErrorWithItsLine) {
  expect_refused("", "axis,speed_mps");
  expect_refused("axis;speed_mps\n", ":1:");
  expect_refused(kHeader + std::string("axis_1,0.5,10\n"), "across_mm");
  expect_refused(kHeader + std::string("axis_1,0.5,10,1,2\n"), "more than four");
  expect_refused(kHeader + std::string("axis_1,0.5,ten,1\n"), "ten");
  expect_refused(kHeader + std::string("axis_1,0.5,10,1\naxis_1,nan,1,1\n"), ":3:");
  expect_refused(kHeader + std::string("axis_1,0.5,10,1x\n"), "1x");
  expect_refused(kHeader + std::string(",0.5,10,1\n"), "axis");
  EXPECT_THROW((void)load_landing_offsets("no_such_file.csv"), ConfigError);
}

}  // namespace
}  // namespace furrow::components
