#include "field_markers.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include "furrow_components/conversions.hpp"
#include "furrow_ledger/palette.hpp"
#include "furrow_msgs/enums.hpp"

namespace furrow::components {

using furrow_msgs::msg::Track;
using std_msgs::msg::ColorRGBA;
using visualization_msgs::msg::Marker;
using visualization_msgs::msg::MarkerArray;

namespace {

namespace Constants = visualization_msgs::msg::Marker_Constants;

constexpr double kPlantHeight_m = 0.01;
constexpr double kSprayHeight_m = 0.004;
constexpr double kLineWidth_m = 0.008;
constexpr double kSmallestPlant_m = 0.005;
constexpr float kTentative = 0.35F;
constexpr float kSolid = 0.9F;

/// Of "#rrggbb".
ColorRGBA color(std::string_view hex, float alpha) {
  const auto channel = [hex](std::size_t at) {
    int value = 0;
    std::from_chars(hex.data() + at, hex.data() + at + 2, value, 16);
    return static_cast<float>(value) / 255.0F;
  };
  ColorRGBA result;
  result.r(channel(1));
  result.g(channel(3));
  result.b(channel(5));
  result.a(alpha);
  return result;
}

/// Ids of RViz have 32 bits.
std::int32_t marker_id(std::int64_t id) {
  return static_cast<std::int32_t>(id & 0x7fffffff);
}

Marker marker(const std_msgs::msg::Header& header, const char* ns, std::int32_t id,
              std::int32_t type) {
  Marker result;
  result.header(header);
  result.ns(ns);
  result.id(id);
  result.type(type);
  result.action(Constants::ADD);
  result.pose().orientation().w(1.0);
  return result;
}

void make_disc(Marker& marker, const geometry_msgs::msg::Point& centre, double radius_m,
               double height_m) {
  marker.pose().position(centre);
  marker.scale().x(2.0 * radius_m);
  marker.scale().y(2.0 * radius_m);
  marker.scale().z(height_m);
}

}  // namespace

FieldMarkers::FieldMarkers(const geometry::ToolModel& tool, double crop_threshold)
    : crop_threshold_(crop_threshold) {
  for (std::size_t i = 0; i < tool.axes.size(); ++i) {
    axes_[tool.axes[i].name] = {i, tool.axes[i].nozzle.footprint_radius_m};
  }
}

MarkerArray FieldMarkers::plants(const furrow_msgs::msg::Tracks& message) {
  MarkerArray result;
  std::set<std::int32_t> drawn;
  for (const Track& track : message.tracks()) {
    if (track.state() == msgs::TrackState::kDeleted) continue;
    const std::int32_t id = marker_id(track.id());
    Marker disc = marker(message.header(), "plants", id, Constants::CYLINDER);
    make_disc(disc, track.position(), std::max(track.radius_m(), kSmallestPlant_m), kPlantHeight_m);
    disc.color(plant_color(track));
    result.markers().push_back(std::move(disc));
    drawn.insert(id);
  }
  for (const std::int32_t id : drawn_plants_) {
    if (drawn.contains(id)) continue;
    Marker gone = marker(message.header(), "plants", id, Constants::CYLINDER);
    gone.action(Constants::DELETE);
    result.markers().push_back(std::move(gone));
  }
  drawn_plants_ = std::move(drawn);
  return result;
}

ColorRGBA FieldMarkers::plant_color(const Track& track) const {
  const float alpha = track.confirmed() ? kSolid : kTentative;
  if (track.crop_probability() >= crop_threshold_) return color(ledger::palette::kCrop, alpha);
  const auto decided = decisions_.find(track.id());
  if (decided == decisions_.end()) return color(ledger::palette::kTreated, alpha);
  // Weeds to treat get the colour that the map has for missed weeds.
  if (decided->second == msgs::DecisionKind::kTreat) return color(ledger::palette::kMissed, alpha);
  return color(ledger::palette::kLeft, alpha);
}

MarkerArray FieldMarkers::plan(const furrow_msgs::msg::Plan& message) {
  decisions_.clear();
  for (const auto& decision : message.decisions()) {
    decisions_[decision.track_id()] = decision.decision();
  }
  MarkerArray result;
  for (const auto& route : message.routes()) {
    const auto axis = axes_.find(route.axis());
    if (axis == axes_.end()) continue;
    Marker line = marker(message.header(), "plan", static_cast<std::int32_t>(axis->second.index),
                         Constants::LINE_STRIP);
    line.scale().x(kLineWidth_m);
    line.color(color(ledger::axis_color(axis->second.index), kSolid));
    for (const auto& stop : route.stops()) line.points().push_back(stop.aim());
    // RViz rejects a line of one point.
    if (line.points().size() == 1) line.points().push_back(line.points().front());
    if (line.points().empty()) line.action(Constants::DELETE);
    result.markers().push_back(std::move(line));
  }
  return result;
}

MarkerArray FieldMarkers::spray(const furrow_msgs::msg::AxisEvent& message) {
  MarkerArray result;
  const auto axis = axes_.find(message.axis());
  if (message.event() != msgs::AxisEventKind::kSprayed || axis == axes_.end()) return result;
  Marker disc = marker(message.header(), "sprays", next_spray_, Constants::CYLINDER);
  next_spray_ = (next_spray_ + 1) % kMaxSprays;
  make_disc(disc, message.landing(), axis->second.footprint_radius_m, kSprayHeight_m);
  disc.color(color(ledger::axis_color(axis->second.index), 0.5F));
  result.markers().push_back(std::move(disc));
  return result;
}

}  // namespace furrow::components
