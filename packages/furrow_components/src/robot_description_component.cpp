#include <memory>
#include <string>
#include <utility>

#include "furrow_components/conversions.hpp"
#include "furrow_components/tool_file.hpp"
#include "furrow_core/file.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_msgs/geometry_msgs.h"
#include "furrow_msgs/std_msgs.h"
#include "furrow_msgs/tf2_msgs.h"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

geometry_msgs::msg::TransformStamped camera_transform(const geometry::CameraModel& camera,
                                                      Time stamp) {
  geometry_msgs::msg::TransformStamped message;
  message.header(header(stamp, kBaseFrame));
  message.child_frame_id(kCameraFrame);
  const Eigen::Vector3d p_BC = camera.X_BC.translation();
  const Eigen::Quaterniond q_BC(camera.X_BC.linear());
  auto& transform = message.transform();
  transform.translation().x(p_BC.x());
  transform.translation().y(p_BC.y());
  transform.translation().z(p_BC.z());
  transform.rotation().x(q_BC.x());
  transform.rotation().y(q_BC.y());
  transform.rotation().z(q_BC.z());
  transform.rotation().w(q_BC.w());
  return message;
}

/// Publishes the latched topics with which ROS 2 viewers draw the robot.
class RobotDescription final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Publishes the URDF and the pose of the camera, for viewers.")
        .parameters<ToolFileParameters>()
        .output<topics::RobotDescription>()
        .output<topics::StaticTransforms>();
  }

  explicit RobotDescription(graph::Context& context) {
    const auto parameters = context.parameters<ToolFileParameters>();
    const geometry::ToolModel tool = geometry::load_tool_model(parameters.tool_file);
    auto urdf = read_file(parameters.tool_file);
    if (!urdf.ok()) throw ConfigError(urdf.error().message);
    std_msgs::msg::String description;
    description.data(std::move(urdf).value());
    context.output<topics::RobotDescription>().publish(std::move(description));
    tf2_msgs::msg::TFMessage transforms;
    if (!tool.cameras.empty()) {
      transforms.transforms().push_back(camera_transform(tool.cameras.front(), context.now()));
    }
    context.output<topics::StaticTransforms>().publish(std::move(transforms));
  }
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::RobotDescription>("robot_description");
}
