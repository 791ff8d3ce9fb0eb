#include "furrow_diagnosis/diagnosis.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "furrow_diagnosis/report.hpp"
#include "sound_sensors.hpp"

namespace furrow::diagnosis {
namespace {

TEST(Diagnosis, FindsNothingInSoundSensors) {
  const Observations seen = sound_sensors();
  const Diagnosis diagnosis = diagnose(seen, sound_expectation());
  EXPECT_TRUE(diagnosis.findings.empty()) << report_text(seen, diagnosis);
  EXPECT_TRUE(diagnosis.not_checked.empty());
}

TEST(Diagnosis, NamesWhatAStandingRobotDoesNotShow) {
  Observations seen = sound_sensors();
  for_each_wheel(seen, [](WheelSample& w) {
    w.position_m.setZero();
    w.speed_mps = w.yaw_rate_radps = 0.0;
  });
  for_each_imu(seen, [](ImuSample& i) { i.rate_radps.setZero(); });
  for_each_fix(seen, [](GnssSample& fix) { fix.covariance_known = false; });
  const Diagnosis diagnosis = diagnose(seen, sound_expectation());
  EXPECT_TRUE(diagnosis.findings.empty()) << report_text(seen, diagnosis);
  ASSERT_EQ(diagnosis.not_checked.size(), 3U);
}

TEST(Diagnosis, RemindsOfOtherHostsWhereAnInputHasNoWriter) {
  Observations seen = sound_sensors();
  seen.only_this_host = true;
  EXPECT_TRUE(diagnose(seen, sound_expectation()).not_checked.empty());
  seen.topics[kGnss].writers.clear();
  seen.topics[kGnss].times.clear();
  seen.topics[kGnss].messages = 0;
  seen.gnss.clear();
  const auto notes = diagnose(seen, sound_expectation()).not_checked;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("interfaces=ADDRESS"), std::string::npos);
}

TEST(Diagnosis, SaysNothingOfTheRateOfOneMessageInAShortTime) {
  Observations seen = sound_sensors();
  seen.seconds = 1.0;
  seen.topics[kGnss].times.resize(1);
  EXPECT_TRUE(diagnose(seen, sound_expectation()).findings.empty());
}

TEST(Diagnosis, PutsTheMoreFundamentalFirst) {
  Observations seen = sound_sensors();
  seen.topics[kImu].frame.clear();
  seen.image->problem = "image encoding 'x' is not one of bgr8";
  shift_stamps(seen.topics[kGnss], 1.0);
  seen.topics[kWheels].writers.push_back({"other", seen.topics[kWheels].type, ""});
  std::vector<std::string> checks;
  for (const Finding& f : diagnose(seen, sound_expectation()).findings) checks.push_back(f.check);
  EXPECT_EQ(checks, (std::vector<std::string>{"topic.two_writers", "stamp.future", "image.encoding",
                                              "imu.frame"}));
}

TEST(Diagnosis, NamesAUnitOfDepthThatFits) {
  Observations seen = sound_sensors();
  seen.depth->median_m = 10.0;  // of 10000 units read as millimetres
  const auto findings = diagnose(seen, sound_expectation()).findings;
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_NE(findings[0].remedy.find("0.000100"), std::string::npos) << findings[0].remedy;
}

TEST(Diagnosis, ComparesTheDepthAlongTheAxisOfATiltedCamera) {
  Observations seen = sound_sensors();
  Expectation expected = sound_expectation();
  // 60 degrees from the vertical: twice the height.
  expected.camera->X_BC.linear() =
      Eigen::AngleAxisd(std::numbers::pi * 2.0 / 3.0, Eigen::Vector3d::UnitX()).matrix();
  expected.ground_distance_m = 2.0;
  seen.depth->median_m = 2.0;
  EXPECT_TRUE(diagnose(seen, expected).findings.empty());
  expected.ground_distance_m = 1.0;
  const auto findings = diagnose(seen, expected).findings;
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].check, "depth.ground_distance");
}

TEST(Diagnosis, AcceptsADifferenceOfAFifthBetweenDepthAndHeight) {
  Observations seen = sound_sensors();
  seen.depth->median_m = 1.19;
  EXPECT_TRUE(diagnose(seen, sound_expectation()).findings.empty());
  seen.depth->median_m = 1.21;
  EXPECT_EQ(diagnose(seen, sound_expectation()).findings.size(), 1U);
}

TEST(Figures, AreThoseOfTheArrivals) {
  const StreamFigures figures = figures_of(sound_sensors().topics[kImu]);
  EXPECT_NEAR(figures.rate_hz.value(), 100.0, 1e-6);
  EXPECT_NEAR(figures.jitter_s.value(), 0.0, 1e-9);
  EXPECT_NEAR(figures.delay_s.value(), 0.011, 1e-9);
  EXPECT_FALSE(figures_of({}).rate_hz.has_value());
}

}  // namespace
}  // namespace furrow::diagnosis
