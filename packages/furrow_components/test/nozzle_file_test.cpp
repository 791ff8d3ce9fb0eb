#include "furrow_components/nozzle_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"

namespace furrow::components {
namespace {

class NozzleFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text) {
    const auto path = std::filesystem::path(testing::TempDir()) / "nozzle_file_test.yaml";
    EXPECT_TRUE(write_file_atomically(path, text).ok());
    return path;
  }
  std::string error(const std::string& text, const std::string& axis) {
    try {
      (void)load_nozzle(write(text), axis);
    } catch (const ConfigError& failure) {
      return failure.what();
    }
    return "";
  }
};

TEST_F(NozzleFile, ReadsWhatItWrites) {
  CalibratedNozzle left{.axis = "left"};
  left.calibration.open_delay_s = 0.0281234567;
  left.calibration.offset_y_m = -0.0123;
  const CalibratedNozzle right{.axis = "right"};
  const auto path = write(nozzle_file_text({left, right}, "Made by a test."));
  const auto nozzles = load_nozzle_file(path);
  ASSERT_EQ(nozzles.size(), 2u);
  EXPECT_NEAR(nozzles[0].calibration.open_delay_s, 0.0281234567, 1e-7);
  EXPECT_NEAR(load_nozzle(path, "left").offset_y_m, -0.0123, 1e-9);
  EXPECT_EQ(load_nozzle(path, "right").flow_mlps, actuation::NozzleCalibration{}.flow_mlps);
}

TEST_F(NozzleFile, ErrorsNameTheCause) {
  EXPECT_NE(error("nozzles:\n  - axis: left\n", "right").find("axis 'right' has no entry"),
            std::string::npos);
  EXPECT_NE(error("nozzles:\n  - axis: a\n  - axis: a\n", "a").find("two entries"),
            std::string::npos);
  EXPECT_NE(error("nozzles:\n  - flow_mlps: 3\n", "a").find("an entry has no axis"),
            std::string::npos);
  EXPECT_NE(error("nozzles:\n  - axis: a\n    open_delay_s: -1\n", "a").find("open_delay_s"),
            std::string::npos);
  EXPECT_NE(error("nozzles:\n  - axis: a\n    delay: 1\n", "a").find("delay"), std::string::npos);
  EXPECT_NE(error("nozzle: 1\n", "a"), "");
  EXPECT_NE(error("", "a"), "");
}

}  // namespace
}  // namespace furrow::components
