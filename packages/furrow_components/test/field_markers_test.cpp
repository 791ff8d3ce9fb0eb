#include "../src/field_markers.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "furrow_components/conversions.hpp"
#include "furrow_msgs/enums.hpp"

namespace furrow::components {
namespace {

using furrow_msgs::msg::Track;
using visualization_msgs::msg::MarkerArray;

geometry::ToolModel two_axes() {
  geometry::ToolModel tool;
  for (const char* name : {"front", "rear"}) {
    geometry::AxisModel axis;
    axis.name = name;
    axis.nozzle.footprint_radius_m = 0.025;
    tool.axes.push_back(axis);
  }
  return tool;
}

Track track(std::int64_t id, double crop_probability) {
  Track result;
  result.id(id);
  result.state(msgs::to_msg(msgs::TrackState::kConfirmed));
  result.confirmed(true);
  result.position(to_point(Eigen::Vector2d(1.0, 0.2)));
  result.radius_m(0.03);
  result.crop_probability(crop_probability);
  return result;
}

furrow_msgs::msg::Tracks tracks(std::vector<Track> list) {
  furrow_msgs::msg::Tracks result;
  result.header(header(Time::from_seconds(3.0), kFieldFrame));
  result.tracks(std::move(list));
  return result;
}

std::array<float, 3> rgb(const visualization_msgs::msg::Marker& marker) {
  return {marker.color().r(), marker.color().g(), marker.color().b()};
}

TEST(FieldMarkers, PlantIsADiscAtItsPosition) {
  FieldMarkers markers(two_axes());
  const MarkerArray array = markers.plants(tracks({track(7, 0.9)}));
  ASSERT_EQ(array.markers().size(), 1U);
  const auto& disc = array.markers().front();
  EXPECT_EQ(disc.header().frame_id(), "field");
  EXPECT_EQ(disc.header().stamp().sec(), 3);
  EXPECT_EQ(disc.ns(), "plants");
  EXPECT_EQ(disc.id(), 7);
  EXPECT_EQ(disc.type(), 3);
  EXPECT_EQ(disc.action(), 0);
  EXPECT_DOUBLE_EQ(disc.pose().position().x(), 1.0);
  EXPECT_DOUBLE_EQ(disc.pose().position().y(), 0.2);
  EXPECT_DOUBLE_EQ(disc.scale().x(), 0.06);
  EXPECT_DOUBLE_EQ(disc.pose().orientation().w(), 1.0);
}

TEST(FieldMarkers, CropTreatedAndLeftWeedsHaveDifferentColours) {
  FieldMarkers markers(two_axes());
  furrow_msgs::msg::Plan plan;
  for (const auto& [id, what] :
       {std::pair{2, msgs::DecisionKind::kTreat}, std::pair{3, msgs::DecisionKind::kLowPriority}}) {
    furrow_msgs::msg::Decision decision;
    decision.track_id(id);
    decision.decision(msgs::to_msg(what));
    plan.decisions().push_back(decision);
  }
  EXPECT_TRUE(markers.plan(plan).markers().empty());
  Track tentative = track(5, 0.1);
  tentative.confirmed(false);
  const auto array = markers.plants(
      tracks({track(1, 0.9), track(2, 0.1), track(3, 0.1), track(4, 0.1), tentative}));
  std::set<std::array<float, 3>> colors;
  for (const auto& marker : array.markers()) colors.insert(rgb(marker));
  EXPECT_EQ(colors.size(), 4U);
  EXPECT_EQ(rgb(array.markers()[3]), rgb(array.markers()[4]));
  EXPECT_LT(array.markers()[4].color().a(), array.markers()[3].color().a());
}

TEST(FieldMarkers, CropBeginsAtTheThreshold) {
  // At 0.3 the second is crop too, the third is not.
  FieldMarkers markers(two_axes(), 0.3);
  const auto array = markers.plants(tracks({track(1, 0.9), track(2, 0.3), track(3, 0.29)}));
  EXPECT_EQ(rgb(array.markers()[0]), rgb(array.markers()[1]));
  EXPECT_NE(rgb(array.markers()[0]), rgb(array.markers()[2]));
}

TEST(FieldMarkers, MarkerOfADeletedTrackIsDeletedOnce) {
  FieldMarkers markers(two_axes());
  (void)markers.plants(tracks({track(1, 0.0), track(2, 0.0)}));
  Track ended = track(1, 0.0);
  ended.state(msgs::to_msg(msgs::TrackState::kDeleted));
  const auto array = markers.plants(tracks({ended, track(2, 0.0)}));
  ASSERT_EQ(array.markers().size(), 2U);
  EXPECT_EQ(array.markers()[1].id(), 1);
  EXPECT_EQ(array.markers()[1].action(), 2);
  EXPECT_EQ(markers.plants(tracks({track(2, 0.0)})).markers().size(), 1U);
}

TEST(FieldMarkers, RouteIsALineThroughItsAims) {
  FieldMarkers markers(two_axes());
  furrow_msgs::msg::AxisRoute route;
  route.axis("rear");
  for (const double x : {1.0, 1.5, 2.0}) {
    furrow_msgs::msg::Stop stop;
    stop.aim(to_point(Eigen::Vector2d(x, -0.1)));
    route.stops().push_back(stop);
  }
  furrow_msgs::msg::AxisRoute empty;
  empty.axis("front");
  furrow_msgs::msg::AxisRoute unknown;
  unknown.axis("of another machine");
  furrow_msgs::msg::Plan plan;
  plan.routes({route, empty, unknown});
  const auto array = markers.plan(plan);
  ASSERT_EQ(array.markers().size(), 2U);
  EXPECT_EQ(array.markers()[0].id(), 1);
  EXPECT_EQ(array.markers()[0].type(), 4);
  ASSERT_EQ(array.markers()[0].points().size(), 3U);
  EXPECT_DOUBLE_EQ(array.markers()[0].points()[2].x(), 2.0);
  EXPECT_EQ(array.markers()[1].id(), 0);
  EXPECT_EQ(array.markers()[1].action(), 2);
}

TEST(FieldMarkers, OnlySpraysLeaveAFootprintAndTheirNumberIsBounded) {
  FieldMarkers markers(two_axes());
  furrow_msgs::msg::AxisEvent event;
  event.axis("front");
  event.event(msgs::to_msg(msgs::AxisEventKind::kStale));
  EXPECT_TRUE(markers.spray(event).markers().empty());
  event.event(msgs::to_msg(msgs::AxisEventKind::kSprayed));
  event.landing(to_point(Eigen::Vector2d(4.0, 0.3)));
  const auto array = markers.spray(event);
  ASSERT_EQ(array.markers().size(), 1U);
  EXPECT_DOUBLE_EQ(array.markers()[0].pose().position().x(), 4.0);
  EXPECT_DOUBLE_EQ(array.markers()[0].scale().x(), 0.05);
  std::set<std::int32_t> ids = {array.markers()[0].id()};
  for (int i = 0; i < 3 * FieldMarkers::kMaxSprays; ++i) {
    ids.insert(markers.spray(event).markers().front().id());
  }
  EXPECT_EQ(ids.size(), static_cast<std::size_t>(FieldMarkers::kMaxSprays));
}

}  // namespace
}  // namespace furrow::components
