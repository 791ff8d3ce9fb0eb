#include "furrow_components/conversions.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_graph/stamp.hpp"

namespace furrow::components {
namespace {

int axis_index(std::span<const std::string> axes, const std::string& name) {
  const auto it = std::ranges::find(axes, name);
  return it == axes.end() ? -1 : static_cast<int>(it - axes.begin());
}

ledger::Decision to_decision(const furrow_msgs::msg::Decision& message,
                             std::span<const std::string> axes) {
  ledger::Decision decision{.time = graph::from_msg(message.stamp()),
                            .track_id = message.track_id()};
  if (message.decision() == "treat") {
    decision.action = ledger::Action::kTreat;
    decision.axis = axis_index(axes, message.axis());
  } else if (const auto reason = ledger::reason_from_string(message.decision())) {
    decision.action = ledger::Action::kLeave;
    decision.reason = *reason;
  }
  return decision;
}

ledger::TrackView to_track_view(const furrow_msgs::msg::Track& message) {
  const Eigen::Vector3d p_F = from_point(message.position());
  return {
      .id = message.id(),
      .p_F_m = p_F.head<2>(),
      .kind = message.crop_probability() > 0.5 ? field::PlantKind::kCrop : field::PlantKind::kWeed,
      .confirmed = message.confirmed(),
      .species = message.species(),
      .radius_m = message.radius_m(),
      .area_mm2 = message.area_mm2()};
}

}  // namespace

std_msgs::msg::Header header(Time stamp, const std::string& frame) {
  std_msgs::msg::Header message;
  message.stamp(graph::to_msg(stamp));
  message.frame_id(frame);
  return message;
}

BaseOdometry from_msg(const nav_msgs::msg::Odometry& message) {
  const auto& pose = message.pose().pose();
  const auto& q = pose.orientation();
  const double heading_rad = std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()),
                                        1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
  return {graph::from_msg(message.header().stamp()),
          {pose.position().x(), pose.position().y(), heading_rad},
          message.twist().twist().linear().x(),
          message.twist().twist().angular().z()};
}

nav_msgs::msg::Odometry to_msg(const BaseOdometry& odometry, const std::string& frame) {
  nav_msgs::msg::Odometry message;
  message.header(header(odometry.stamp, frame));
  message.child_frame_id(kBaseFrame);
  auto& pose = message.pose().pose();
  pose.position().x(odometry.X_FB.x_m);
  pose.position().y(odometry.X_FB.y_m);
  pose.orientation().z(std::sin(0.5 * odometry.X_FB.heading_rad));
  pose.orientation().w(std::cos(0.5 * odometry.X_FB.heading_rad));
  message.twist().twist().linear().x(odometry.speed_mps);
  message.twist().twist().angular().z(odometry.yaw_rate_radps);
  return message;
}

geometry_msgs::msg::Point to_point(const Eigen::Vector3d& p) {
  geometry_msgs::msg::Point message;
  message.x(p.x());
  message.y(p.y());
  message.z(p.z());
  return message;
}

geometry_msgs::msg::Point to_point(const Eigen::Vector2d& p) {
  return to_point(Eigen::Vector3d(p.x(), p.y(), 0.0));
}

Eigen::Vector3d from_point(const geometry_msgs::msg::Point& p) {
  return {p.x(), p.y(), p.z()};
}

furrow_msgs::msg::TrueField to_msg(const field::FieldModel& field, Time stamp) {
  furrow_msgs::msg::TrueField message;
  message.header(header(stamp, kFieldFrame));
  message.name(field.name);
  message.source(field.source);
  message.length_m(field.length_m);
  message.width_m(field.width_m);
  message.row_y_m(field.row_y_m);
  for (const field::Plant& plant : field.plants) {
    furrow_msgs::msg::TruePlant& entry = message.plants().emplace_back();
    entry.id(plant.id);
    entry.crop(plant.kind == field::PlantKind::kCrop);
    entry.species(plant.species);
    entry.position(to_point(plant.p_F_m));
    entry.radius_m(plant.radius_m);
    entry.area_mm2(plant.area_mm2);
    entry.leaves(static_cast<std::uint8_t>(std::clamp(plant.leaves, 0, 255)));
    entry.heading_rad(plant.heading_rad);
  }
  return message;
}

field::FieldModel from_msg(const furrow_msgs::msg::TrueField& message) {
  field::FieldModel field{.name = message.name(),
                          .source = message.source(),
                          .length_m = message.length_m(),
                          .width_m = message.width_m(),
                          .row_y_m = message.row_y_m()};
  for (const furrow_msgs::msg::TruePlant& entry : message.plants()) {
    field.plants.push_back(
        {.id = entry.id(),
         .kind = entry.crop() ? field::PlantKind::kCrop : field::PlantKind::kWeed,
         .species = entry.species(),
         .p_F_m = from_point(entry.position()).head<2>(),
         .radius_m = entry.radius_m(),
         .area_mm2 = entry.area_mm2(),
         .leaves = entry.leaves(),
         .heading_rad = entry.heading_rad()});
  }
  return field;
}

sensor_msgs::msg::CameraInfo to_msg(const geometry::CameraIntrinsics& intrinsics, Time stamp) {
  sensor_msgs::msg::CameraInfo message;
  message.header(header(stamp, kCameraFrame));
  message.width(static_cast<std::uint32_t>(intrinsics.width_px));
  message.height(static_cast<std::uint32_t>(intrinsics.height_px));
  message.distortion_model("plumb_bob");
  message.d(std::vector<double>(5, 0.0));
  message.k({intrinsics.fx_px, 0.0, intrinsics.cx_px, 0.0, intrinsics.fy_px, intrinsics.cy_px, 0.0,
             0.0, 1.0});
  message.r({1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0});
  message.p({intrinsics.fx_px, 0.0, intrinsics.cx_px, 0.0, 0.0, intrinsics.fy_px, intrinsics.cy_px,
             0.0, 0.0, 0.0, 1.0, 0.0});
  return message;
}

geometry::CameraIntrinsics from_msg(const sensor_msgs::msg::CameraInfo& message) {
  return {static_cast<int>(message.width()),
          static_cast<int>(message.height()),
          message.k()[0],
          message.k()[4],
          message.k()[2],
          message.k()[5]};
}

ledger::RunRecord from_msg(const furrow_msgs::msg::RunRecord& message,
                           std::span<const std::string> axes) {
  ledger::RunRecord record;
  record.info.speed_mps = message.mean_speed_mps();
  record.info.distance_m = message.distance_m();
  record.info.duration_s = message.duration_s();
  record.info.axis_travel_m.assign(axes.size(), 0.0);
  for (const auto& track : message.tracks()) record.tracks.push_back(to_track_view(track));
  for (const auto& decision : message.decisions()) {
    record.decisions.push_back(to_decision(decision, axes));
  }
  for (const auto& event : message.events()) {
    // What a driver gave up stays given up, whatever the planner still hoped for afterwards.
    const auto reason = ledger::reason_from_string(event.event());
    if (!reason || *reason == ledger::Reason::kNone) continue;
    for (const std::int64_t track : event.track_ids()) {
      record.decisions.push_back({.time = graph::from_msg(message.header().stamp()),
                                  .track_id = track,
                                  .action = ledger::Action::kLeave,
                                  .reason = *reason,
                                  .axis = axis_index(axes, event.axis())});
    }
  }
  for (const auto& spray : message.sprays()) {
    record.sprays.push_back({.time = graph::from_msg(spray.header().stamp()),
                             .axis = axis_index(axes, spray.axis()),
                             .p_F_m = from_point(spray.centre()).head<2>(),
                             .radius_m = spray.radius_m(),
                             .aim_F_m = from_point(spray.aim()).head<2>(),
                             .track_ids = spray.track_ids()});
  }
  for (const auto& path : message.paths()) {
    const int axis = axis_index(axes, path.axis());
    if (axis < 0) continue;
    record.info.axis_travel_m[static_cast<std::size_t>(axis)] = path.travel_m();
    ledger::RouteView& route = record.routes.emplace_back();
    route.axis = axis;
    for (const auto& point : path.points()) route.p_F_m.push_back(from_point(point).head<2>());
  }
  return record;
}

}  // namespace furrow::components
