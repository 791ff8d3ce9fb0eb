#include "furrow_geometry/tool_model.hpp"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>

#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"
#include "urdf_extensions.hpp"

namespace furrow::geometry {
namespace {

/// Largest slope of an axis. Beyond it the nozzle's height and footprint would change along it.
constexpr double kMaxSlope = 0.05;

/// urdfdom reports errors only through console_bridge's global handler.
class LogCapture final : public console_bridge::OutputHandler {
 public:
  LogCapture() : lock_(mutex()), previous_(console_bridge::getOutputHandler()) {
    console_bridge::useOutputHandler(this);
  }
  ~LogCapture() override { console_bridge::useOutputHandler(previous_); }
  LogCapture(const LogCapture&) = delete;
  LogCapture& operator=(const LogCapture&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char* /*filename*/,
           int /*line*/) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (!text_.empty()) text_ += "; ";
    text_ += text;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }
  std::lock_guard<std::mutex> lock_;
  console_bridge::OutputHandler* previous_;
  std::string text_;
};

urdf::ModelInterfaceSharedPtr parse_tree(std::string_view urdf, const std::string& file) {
  LogCapture capture;
  urdf::ModelInterfaceSharedPtr model;
  try {
    model = urdf::parseURDF(std::string(urdf));
  } catch (const std::exception& error) {
    throw ConfigError({file, 0}, "urdf", error.what());
  }
  if (model == nullptr) {
    throw ConfigError({file, 0}, "urdf",
                      capture.text().empty() ? "urdfdom refuses the file" : capture.text());
  }
  return model;
}

Eigen::Isometry3d to_isometry(const urdf::Pose& pose) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() << pose.position.x, pose.position.y, pose.position.z;
  const Eigen::Quaterniond q(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  X.linear() = q.normalized().toRotationMatrix();
  return X;
}

/// The chain from the base to a link: its pose with every joint at zero, and the movable joints.
struct Chain {
  Eigen::Isometry3d X_BL = Eigen::Isometry3d::Identity();
  std::vector<urdf::JointConstSharedPtr> moving;  ///< from the link towards the base
  std::vector<Eigen::Isometry3d> X_JL;            ///< the link in each moving joint's frame
};

class ToolBuilder {
 public:
  ToolBuilder(std::string_view urdf, std::string_view origin)
      : file_(origin),
        extensions_(read_urdf_extensions(urdf, origin)),
        tree_(parse_tree(urdf, file_)) {}

  [[nodiscard]] ToolModel build() const {
    if (tree_->getLink(extensions_.base_link) == nullptr) {
      fail(extensions_.line, "<furrow>", "there is no base link '" + extensions_.base_link + "'");
    }
    ToolModel tool;
    tool.robot = tree_->getName();
    tool.base_link = extensions_.base_link;
    for (const NozzleElement& nozzle : extensions_.nozzles) {
      tool.axes.push_back(build_axis(nozzle));
    }
    check_every_axis_once(tool.axes);
    std::sort(tool.axes.begin(), tool.axes.end(), ahead_of);
    std::set<std::string> seen;
    for (const CameraElement& camera : extensions_.cameras) {
      if (!seen.insert(camera.link).second) {
        fail(camera.line, link_key(camera.link), "the link carries two cameras");
      }
      tool.cameras.push_back(build_camera(camera));
    }
    return tool;
  }

 private:
  [[noreturn]] void fail(int line, const std::string& key, const std::string& message) const {
    throw ConfigError({file_, line}, key, message);
  }
  /// To the micrometre: rounding in the transforms must not decide between equal places.
  static bool ahead_of(const AxisModel& a, const AxisModel& b) {
    const auto a_um = std::llround(1e6 * a.p_BN0.x());
    const auto b_um = std::llround(1e6 * b.p_BN0.x());
    return a_um != b_um ? a_um > b_um : a.name < b.name;
  }
  static std::string link_key(const std::string& name) { return "link '" + name + "'"; }
  static std::string joint_key(const std::string& name) { return "joint '" + name + "'"; }

  [[nodiscard]] Chain chain_to(const std::string& link_name, int line) const {
    urdf::LinkConstSharedPtr link = tree_->getLink(link_name);
    if (link == nullptr) fail(line, link_key(link_name), "there is no such link");
    Chain chain;
    while (link->name != extensions_.base_link) {
      const urdf::JointConstSharedPtr joint = link->parent_joint;
      if (joint == nullptr) {
        fail(line, link_key(link_name), "it does not hang on '" + extensions_.base_link + "'");
      }
      if (joint->type != urdf::Joint::FIXED) {
        chain.moving.push_back(joint);
        chain.X_JL.push_back(chain.X_BL);
      }
      chain.X_BL = to_isometry(joint->parent_to_joint_origin_transform) * chain.X_BL;
      link = tree_->getLink(joint->parent_link_name);
    }
    return chain;
  }

  [[nodiscard]] AxisModel build_axis(const NozzleElement& nozzle) const {
    const Chain chain = chain_to(nozzle.link, nozzle.line);
    if (chain.moving.size() != 1 || chain.moving.front()->type != urdf::Joint::PRISMATIC) {
      fail(nozzle.line, link_key(nozzle.link),
           "between the base and a nozzle there must be one prismatic joint and else fixed ones");
    }
    const urdf::Joint& joint = *chain.moving.front();
    const PrismaticElement& element = extensions_.prismatic.at(joint.name);
    const Eigen::Vector3d axis_J(joint.axis.x, joint.axis.y, joint.axis.z);
    if (!(axis_J.norm() > 1e-9)) fail(element.line, joint_key(joint.name), "its <axis> is zero");
    const Eigen::Isometry3d X_BJ = chain.X_BL * chain.X_JL.front().inverse();

    AxisModel axis;
    axis.name = joint.name;
    axis.p_BN0 = chain.X_BL.translation();
    axis.direction_B = X_BJ.linear() * axis_J.normalized();
    axis.lower_m = element.limit.lower_m;
    axis.upper_m = element.limit.upper_m;
    axis.max_velocity_mps = element.limit.velocity_mps;
    axis.max_acceleration_mps2 = element.limit.acceleration_mps2;
    axis.max_jerk_mps3 = element.limit.jerk_mps3;
    axis.nozzle = {nozzle.link, nozzle.footprint_radius_m, axis.p_BN0.z()};
    if (std::abs(axis.direction_B.z()) > kMaxSlope) {
      fail(element.line, joint_key(joint.name), "an axis must run level with the ground");
    }
    if (!(axis.nozzle.height_m > 0.0)) {
      fail(nozzle.line, link_key(nozzle.link), "a nozzle must stand above the ground (z > 0)");
    }
    return axis;
  }

  void check_every_axis_once(const std::vector<AxisModel>& axes) const {
    std::set<std::string> carrying;
    for (const AxisModel& axis : axes) {
      if (!carrying.insert(axis.name).second) {
        fail(extensions_.prismatic.at(axis.name).line, joint_key(axis.name),
             "it carries two nozzles; an axis has one");
      }
    }
    for (const auto& [name, element] : extensions_.prismatic) {
      if (!carrying.contains(name)) {
        fail(element.line, joint_key(name), "a prismatic joint without a <nozzle> in <furrow>");
      }
    }
    if (axes.empty()) fail(extensions_.line, "<furrow>", "there is no axis with a nozzle");
  }

  [[nodiscard]] CameraModel build_camera(const CameraElement& camera) const {
    const Chain chain = chain_to(camera.link, camera.line);
    if (!chain.moving.empty()) {
      fail(camera.line, link_key(camera.link),
           "the joint '" + chain.moving.front()->name + "' moves the camera; it must be fixed");
    }
    return {camera.link, camera.intrinsics, chain.X_BL};
  }

  std::string file_;
  UrdfExtensions extensions_;
  urdf::ModelInterfaceSharedPtr tree_;
};

}  // namespace

ToolModel parse_tool_model(std::string_view urdf, std::string_view origin) {
  return ToolBuilder(urdf, origin).build();
}

ToolModel load_tool_model(const std::filesystem::path& path) {
  const Result<std::string> text = read_file(path, 16u << 20);
  if (!text.ok()) throw ConfigError({path.string(), 0}, "urdf", text.error().message);
  return parse_tool_model(*text, path.string());
}

}  // namespace furrow::geometry
