#include "furrow_components/conversions.hpp"

#include <cmath>

#include "furrow_core/text.hpp"
#include "furrow_graph/stamp.hpp"

namespace furrow::components {

bool in_field(double x_m, double y_m) {
  // Written so that NaN fails.
  return std::abs(x_m) <= kMaxField_m && std::abs(y_m) <= kMaxField_m;
}

std::string outside_field(std::string_view topic, const geometry::Pose2& X_FB) {
  return std::string(topic) + " starts at x " + fixed(X_FB.x_m, 1) + " m, y " + fixed(X_FB.y_m, 1) +
         " m, more than 10 km from the origin of the field frame; is it a "
         "map frame, such as UTM?";
}

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

}  // namespace furrow::components
