#include "furrow_evaluation/vision_report.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace furrow::evaluation {
namespace {

// The test vectors of RFC 4648.
TEST(Base64, KnownTexts) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe"), "//4=");
}

TEST(VisionReport, WhatADataSetDoesNotSayIsNull) {
  VisionReport report;
  report.seed = 7;
  report.rows.push_back({.dataset = "a<b", .detector = "index", .scores = {}, .ms_per_frame = 3.5});
  report.rows[0].scores.images = 2;
  report.rows[0].scores.miou = 0.5;
  report.rows[0].scores.stem_p50_mm = std::numeric_limits<double>::quiet_NaN();
  report.pictures.push_back(
      {.dataset = "a<b", .detector = "index", .file = "x.png", .jpeg = "foo"});
  const auto json = nlohmann::json::parse(to_json(report));
  const auto& row = json.at("rows").at(0);
  EXPECT_EQ(row.at("images"), 2);
  EXPECT_EQ(row.at("miou"), 0.5);
  EXPECT_TRUE(row.at("stem_p50_mm").is_null());
  EXPECT_EQ(row.at("ms_per_frame"), 3.5);
  EXPECT_EQ(json.at("seed"), 7);
  const std::string html = to_html(report);
  EXPECT_NE(html.find("a&lt;b"), std::string::npos);
  EXPECT_EQ(html.find("a<b"), std::string::npos);
  EXPECT_NE(html.find("data:image/jpeg;base64,Zm9v"), std::string::npos);
}

}  // namespace
}  // namespace furrow::evaluation
