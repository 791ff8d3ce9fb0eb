#include "furrow_ledger/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <regex>

#include "../src/map_layout.hpp"
#include "xml_check.hpp"

namespace furrow::ledger {
namespace {

struct Example {
  field::FieldModel field;
  RunRecord record;
};

/// Three weeds (treated, missed for being unseen, left on purpose) and a crop that is hit.
Example example() {
  Example run;
  run.field.name = "example <1>";
  run.field.source = "generated: \"three\" & one";
  run.field.length_m = 12.0;
  run.field.width_m = 1.4;
  run.field.row_y_m = {-0.25, 0.25};
  const auto add = [&](std::int64_t id, field::PlantKind kind, double x, double y) {
    field::Plant plant;
    plant.id = id;
    plant.kind = kind;
    plant.species = "s<" + std::to_string(id) + ">";
    plant.p_F_m = {x, y};
    plant.radius_m = 0.02;
    run.field.plants.push_back(plant);
  };
  add(1, field::PlantKind::kWeed, 1.0, 0.1);
  add(2, field::PlantKind::kWeed, 6.0, -0.1);
  add(3, field::PlantKind::kWeed, 11.0, 0.0);
  add(4, field::PlantKind::kCrop, 1.015, 0.1);
  run.record.tracks = {{.id = 1, .p_F_m = {1.0, 0.1}, .confirmed = true},
                       {.id = 3, .p_F_m = {11.0, 0.0}, .confirmed = true}};
  run.record.decisions = {
      {.track_id = 3, .action = Action::kLeave, .reason = Reason::kLowPriority}};
  Spray spray;
  spray.p_F_m = spray.aim_F_m = {1.001, 0.1};
  spray.track_ids = {1};
  spray.sweep_F_m = {0.01, 0.002};
  run.record.sprays = {spray};
  run.record.routes = {{0, {{0.0, 0.0}, {1.0, 0.1}, {12.0, 0.0}}}};
  run.record.tables = {{"health <t>", {"component", "drops"}, {{"cam<era>", "0"}}}};
  run.record.info.graph = "graph<gr>.yaml";
  run.record.info.more = {{"deployment", "composed<d>"}};
  run.record.info.reach_y_m = {-0.6, 0.6};
  run.record.info.axis_travel_m = {3.0};
  return run;
}

Ledger account_of(const Example& run) {
  auto ledger = account(run.field, run.record);
  EXPECT_TRUE(ledger.ok());
  return *ledger;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(Map, IsWellFormedAndShowsEveryPlantOnce) {
  const Example run = example();
  const std::string svg = map_svg(account_of(run), run.record);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(occurrences(svg, "<clipPath"), 3u);  // 12 m in strips of 5 m
  for (const char* text :
       {"weed 1, s&lt;1&gt;: accurate", "weed 2, s&lt;2&gt;: missed, not detected",
        "weed 3, s&lt;3&gt;: missed, left on purpose", "crop 4, s&lt;4&gt;: hit"}) {
    EXPECT_EQ(occurrences(svg, text), 1u) << text;
  }
  EXPECT_NE(svg.find("simulated run"), std::string::npos);
}

TEST(Map, FootprintsAreToScale) {
  const Example run = example();
  const std::string svg = map_svg(account_of(run), run.record);
  const MapLayout layout = make_map_layout(account_of(run), 1e9);
  const std::regex circle("r=\"([0-9.]+)\" fill=\"#2f6fde\" fill-opacity=\"0.2\"");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(svg, match, circle));
  EXPECT_NEAR(std::stod(match[1]), 0.025 * layout.px_per_m, 0.01);
}

TEST(Map, LeftOfTheRobotIsUp) {
  const MapLayout layout = make_map_layout(account_of(example()), 1e9);
  EXPECT_LT(layout.y_px(0, 0.5), layout.y_px(0, -0.5));
  EXPECT_LT(layout.x_px(1, 6.0), layout.x_px(1, 7.0));
  EXPECT_DOUBLE_EQ(layout.x_px(0, 1.0), layout.x_px(1, 6.0));
}

TEST(Map, PlantOnACutIsInBothStrips) {
  Example run = example();
  run.field.plants[1].p_F_m.x() = 5.0;
  EXPECT_EQ(occurrences(map_svg(account_of(run), run.record), "weed 2,"), 2u);
}

TEST(Map, SurvivesRunsThatAreEmptyOrStrange) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(xml_fault(map_svg({}, {})), "");
  Example run = example();
  run.field.length_m = nan;
  run.field.width_m = 1e30;
  run.field.row_y_m = {nan, 1e9};
  run.record.routes = {{0, {{nan, 0.0}, {1e300, 2.0}, {1.0, 0.0}}}, {-3, {{0.0, 0.0}}}, {1, {}}};
  run.record.sprays[0].sweep_F_m = {nan, nan};
  run.record.info.reach_y_m = {nan, nan};
  const std::string svg = map_svg(account_of(run), run.record);
  EXPECT_EQ(xml_fault(svg), "");
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("=\"-\""), std::string::npos);  // a number that is not finite
}

TEST(Simplified, StaysWithinTheToleranceAndKeepsTurningPoints) {
  std::vector<Eigen::Vector2d> route;
  for (int i = 0; i <= 2000; ++i) {
    const double t = i / 1000.0;
    // Across and back on one line, then a curve.
    route.emplace_back(t < 1.0 ? 0.0 : t - 1.0,
                       t < 1.0 ? 0.5 - std::abs(t - 0.5) : std::sin(3 * t) - std::sin(3.0));
  }
  const double tolerance_m = 0.002;
  const auto kept = simplified(route, tolerance_m);
  EXPECT_LT(kept.size(), 60u);
  EXPECT_EQ(kept.front(), route.front());
  EXPECT_EQ(kept.back(), route.back());
  for (const Eigen::Vector2d& p : route) {
    double nearest_m = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
      const Eigen::Vector2d d = kept[i + 1] - kept[i];
      const double s = std::clamp((p - kept[i]).dot(d) / d.squaredNorm(), 0.0, 1.0);
      nearest_m = std::min(nearest_m, (p - kept[i] - s * d).norm());
    }
    EXPECT_LE(nearest_m, 2 * tolerance_m);
  }
}

TEST(Report, IsSelfContainedAndEscaped) {
  const Example run = example();
  const std::string html = report_html(account_of(run), run.record);
  for (const char* raw : {"<1>", "s<2>", "<t>", "<era>", "<gr>", "<d>"}) {
    EXPECT_EQ(html.find(raw), std::string::npos) << raw;
  }
  for (const char* shown : {"graph&lt;gr&gt;.yaml", "composed&lt;d&gt;", "cam&lt;era&gt;",
                            "not detected", "left on purpose", "simulated", "Missed weeds"}) {
    EXPECT_NE(html.find(shown), std::string::npos) << shown;
  }
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(html.find("src="), std::string::npos);
  EXPECT_EQ(occurrences(html, "http"), occurrences(html, "http://www.w3.org/2000/svg"));
}

TEST(Report, OfAnEmptyRun) {
  const std::string html = report_html({}, {});
  EXPECT_NE(html.find("no data"), std::string::npos);
  EXPECT_EQ(html.find("Missed weeds</h2>"), std::string::npos);
}

TEST(Report, OfARealRunDoesNotSaySimulated) {
  Example run = example();
  run.record.info.simulated = false;
  auto ledger = account_tracks(run.field, run.record);
  ASSERT_TRUE(ledger.ok());
  const std::string html = report_html(*ledger, run.record);
  EXPECT_EQ(html.find("imulated"), std::string::npos);
  EXPECT_NE(html.find("the robot&#39;s own tracks"), std::string::npos);
}

TEST(Report, OfAnInterruptedRunSaysSo) {
  Example run = example();
  for (const bool interrupted : {false, true}) {
    run.record.info.interrupted = interrupted;
    const auto ledger = account(run.field, run.record);
    ASSERT_TRUE(ledger.ok());
    EXPECT_EQ(ledger->summary.interrupted, interrupted);
    EXPECT_EQ(report_html(*ledger, run.record).find("interrupted") != std::string::npos,
              interrupted);
    EXPECT_EQ(map_svg(*ledger, run.record).find("interrupted") != std::string::npos, interrupted);
    const std::string flag = std::string("\"interrupted\": ") + (interrupted ? "true" : "false");
    EXPECT_NE(to_json(ledger->summary).find(flag), std::string::npos);
  }
}

}  // namespace
}  // namespace furrow::ledger
