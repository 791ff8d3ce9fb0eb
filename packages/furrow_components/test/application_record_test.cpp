#include "furrow_components/application_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "furrow_components/conversions.hpp"
#include "furrow_core/file.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/enums.hpp"

namespace furrow::components {
namespace {

using msgs::AxisEventKind;

geometry::ToolModel tool() {
  geometry::ToolModel tool;
  geometry::AxisModel& axis = tool.axes.emplace_back();
  axis.name = "axis_1";
  axis.lower_m = -0.5;
  axis.upper_m = 0.5;
  axis.nozzle.footprint_radius_m = 0.025;
  return tool;
}

furrow_msgs::msg::AxisEvent event(AxisEventKind kind, double x_m, double y_m) {
  furrow_msgs::msg::AxisEvent event;
  event.axis("axis_1");
  event.event(msgs::to_msg(kind));
  event.opened(graph::to_msg(Time::from_seconds(10.0)));
  event.closed(graph::to_msg(Time::from_seconds(10.02)));
  event.header().stamp(event.closed());
  event.landing(to_point(Eigen::Vector2d(x_m, y_m)));
  event.volume_ml(0.1);
  return event;
}

furrow_msgs::msg::RunRecord record() {
  furrow_msgs::msg::RunRecord record;
  record.distance_m(13.0);
  record.field().length_m(10.0);
  record.field().row_y_m({0.25, -0.25});
  record.events({event(AxisEventKind::kSprayed, 1.0, 0.2),
                 event(AxisEventKind::kSprayed, 2.0, -0.4), event(AxisEventKind::kDryRun, 3, 0),
                 event(AxisEventKind::kStale, 4.0, 0.0),
                 event(AxisEventKind::kSprayed, 5.0, -0.1)});
  auto& other = record.events().emplace_back(event(AxisEventKind::kSprayed, 6.0, 0.0));
  other.axis("other_axis");
  auto& safe = record.events().emplace_back(event(AxisEventKind::kSafeState, 0.0, 0.0));
  safe.cause(msgs::to_msg(msgs::SafetyCause::kPlanStale));
  auto& state = record.axes().emplace_back();
  state.axis("axis_1");
  state.mode(msgs::to_msg(msgs::AxisMode::kSafe));
  state.cause(msgs::to_msg(msgs::SafetyCause::kPlanStale));
  state.openings(3);
  state.open_s(0.06);
  state.volume_ml(0.3);
  return record;
}

using Rows = std::vector<std::vector<std::string>>;

TEST(ApplicationRecord, ListsTheSpraysOfTheDrivers) {
  const auto sprays = applications_of(record(), tool());
  ASSERT_EQ(sprays.size(), 3u);
  EXPECT_EQ(sprays[1].p_F, Eigen::Vector2d(2.0, -0.4));
  EXPECT_NEAR(sprays[1].open_s, 0.02, 1e-9);
  EXPECT_EQ(sprays[1].radius_m, 0.025);
}

TEST(ApplicationRecord, ReportsUseByNozzleRowAndArea) {
  const auto tables = use_tables(record(), applications_of(record(), tool()), tool());
  ASSERT_EQ(tables.size(), 4u);
  EXPECT_EQ(tables[0].rows, (Rows{{"axis_1", "3", "0.06 s", "0.3 ml", "safe: plan_stale"}}));
  EXPECT_EQ(tables[1].rows,
            (Rows{{"-0.25 m", "2", "0.2 ml", "0.02 ml"}, {"0.25 m", "1", "0.1 ml", "0.01 ml"}}));
  // 10 m of field times the reach of the axis with a footprint on either side.
  EXPECT_EQ(tables[2].rows[0], (std::vector<std::string>{"covered", "10.50 m2"}));
  // Three footprints of 19.6 cm2.
  EXPECT_EQ(tables[2].rows[1], (std::vector<std::string>{"sprayed", "0.006 m2"}));
  EXPECT_EQ(tables[3].rows, (Rows{{"10.020 s", "axis_1", "plan_stale", "20.00 ms"}}));
}

TEST(ApplicationRecord, EmptyRunReportsItsAreaOnly) {
  const furrow_msgs::msg::RunRecord empty;
  const auto tables = use_tables(empty, {}, tool());
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[0].rows.size(), 2u);  // no shares
}

TEST(ApplicationRecord, WritesTheMapOnlyWithAnOrigin) {
  const auto folder = std::filesystem::path(testing::TempDir()) / "application_record";
  std::filesystem::remove_all(folder);
  auto run = record();
  EXPECT_TRUE(write_as_applied(folder, run, applications_of(run, tool())).ok());
  EXPECT_FALSE(std::filesystem::exists(folder / "as_applied.geojson"));
  run.georeferenced(true);
  run.origin_latitude_deg(50.0);
  run.origin_longitude_deg(7.0);
  EXPECT_TRUE(write_as_applied(folder, run, applications_of(run, tool())).ok());
  const auto text = read_file(folder / "as_applied.geojson");
  ASSERT_TRUE(text.ok());
  // 1 m east of the origin is 180 / (pi N cos 50 deg) degrees, N = a / sqrt(1 - e2 sin2 50 deg).
  constexpr double kA_m = 6378137.0;
  constexpr double kE2 = 0.00669437999014;
  const double latitude = 50.0 * std::numbers::pi / 180.0;
  const double n_m = kA_m / std::sqrt(1.0 - kE2 * std::pow(std::sin(latitude), 2));
  const double east_deg = 180.0 / (std::numbers::pi * n_m * std::cos(latitude));
  const std::string expected = std::to_string(std::lround((7.0 + east_deg) * 1e9));
  EXPECT_NE(text->find("7." + expected.substr(1)), std::string::npos) << *text;

  // 6378 m above the ellipsoid a metre is about a thousandth less of a degree.
  run.origin_altitude_m(6378.137);
  EXPECT_TRUE(write_as_applied(folder, run, applications_of(run, tool())).ok());
  const auto above = read_file(folder / "as_applied.geojson");
  ASSERT_TRUE(above.ok());
  const double less_deg = east_deg * n_m / (n_m + 6378.137);
  const std::string shorter = std::to_string(std::lround((7.0 + less_deg) * 1e9));
  EXPECT_NE(above->find("7." + shorter.substr(1)), std::string::npos) << *above;
}

}  // namespace
}  // namespace furrow::components
