#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "furrow_benchmarks/graph_benchmark_report.hpp"
#include "furrow_benchmarks/recording_benchmark_report.hpp"
#include "furrow_benchmarks/vision_benchmark.hpp"

namespace furrow::benchmarks {
namespace {

TEST(GraphBenchmarkReport, RatiosCompareThePathsTheyName) {
  GraphBenchmarkResult result;
  result.rows = {
      {.path = "in_process", .bytes = 100, .p50_us = 20.0, .p99_us = 40.0},
      {.path = "in_process", .bytes = 6'000'000, .p50_us = 25.0, .p99_us = 50.0},
      {.path = "in_process_observed", .bytes = 6'000'000, .p50_us = 30.0, .p99_us = 100.0},
      {.path = "two_processes", .bytes = 6'000'000, .p50_us = 3300.0, .p99_us = 1.0, .lost = 2},
      {.path = "fastdds_two_processes", .bytes = 6'000'000, .p50_us = 3000.0, .p99_us = 1.0}};
  const auto json = nlohmann::json::parse(to_json({}, result, "1.2.3"));
  EXPECT_EQ(json.at("rows").size(), result.rows.size());
  EXPECT_EQ(json.at("rows").at(3).at("lost"), 2);
  const auto& ratios = json.at("ratios");
  EXPECT_DOUBLE_EQ(ratios.at("in_process_6mb_over_100b_p50"), 1.25);
  EXPECT_DOUBLE_EQ(ratios.at("observed_over_alone_6mb_p99"), 2.0);
  EXPECT_DOUBLE_EQ(ratios.at("two_processes_over_fastdds_6mb_p50"), 1.1);
  // Not measured.
  EXPECT_DOUBLE_EQ(ratios.at("distributed_over_composed_p50"), 0.0);
  EXPECT_EQ(json.at("version"), "1.2.3");
  EXPECT_NE(to_text(result).find("in_process_6mb_over_100b_p50: 1.250"), std::string::npos);
}

TEST(RecordingBenchmarkReport, HasARowForEachMeasure) {
  RecordingBenchmarkResult result;
  result.writes = {{.recorder_mbps = 900.0, .dd_mbps = 1000.0}};
  result.graph.messages = 30;
  result.playback.published_p99_ms = 0.25;
  const auto json = nlohmann::json::parse(to_json({}, result, "1.2.3"));
  ASSERT_EQ(json.at("rows").size(), 3u);
  EXPECT_DOUBLE_EQ(json.at("rows").at(0).at("ratio"), 0.9);
  EXPECT_EQ(json.at("rows").at(1).at("messages"), 30);
  EXPECT_DOUBLE_EQ(json.at("rows").at(2).at("published_p99_ms"), 0.25);
}

TEST(VisionBenchmarkReport, HasTheKeysThatScriptsRead) {
  const auto json = nlohmann::json::parse(
      to_json({.seed = 7},
              {{.detector = "index", .width_px = 640, .height_px = 480, .ms_p50 = 3.5}}, "1.2.3"));
  const auto& row = json.at("rows").at(0);
  EXPECT_EQ(row.at("detector"), "index");
  EXPECT_EQ(row.at("width"), 640);
  EXPECT_EQ(row.at("height"), 480);
  EXPECT_EQ(row.at("ms_p50"), 3.5);
  EXPECT_EQ(json.at("seed"), 7);
}

}  // namespace
}  // namespace furrow::benchmarks
