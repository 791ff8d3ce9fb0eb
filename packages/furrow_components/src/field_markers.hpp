#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "furrow_geometry/tool_model.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/visualization_msgs.h"

namespace furrow::components {

/// What RViz draws of a run, in the field frame: plants as discs in the colour of what they are and
/// what was decided, the routes of the axes as lines through their aims, sprays as the footprint
/// where it landed. Bounded: plants go with their tracks, the oldest spray is drawn over.
class FieldMarkers {
 public:
  static constexpr std::int32_t kMaxSprays = 2000;

  /// The model is copied from. Tracks at or above the threshold are drawn as crop.
  explicit FieldMarkers(const geometry::ToolModel& tool, double crop_threshold = 0.5);

  /// Every track that has not ended, in namespace "plants"; those that were there before and are
  /// not any more are deleted.
  [[nodiscard]] visualization_msgs::msg::MarkerArray plants(
      const furrow_msgs::msg::Tracks& message);
  /// A line per axis, in namespace "plan"; deleted when its route is empty. The decisions colour
  /// the plants from then on.
  [[nodiscard]] visualization_msgs::msg::MarkerArray plan(const furrow_msgs::msg::Plan& message);
  /// The footprint of a spray, in namespace "sprays"; empty for other events.
  [[nodiscard]] visualization_msgs::msg::MarkerArray spray(
      const furrow_msgs::msg::AxisEvent& message);

 private:
  [[nodiscard]] std_msgs::msg::ColorRGBA plant_color(const furrow_msgs::msg::Track& track) const;

  struct Axis {
    std::size_t index = 0;
    double footprint_radius_m = 0.0;
  };
  double crop_threshold_;
  std::map<std::string, Axis> axes_;
  std::map<std::int64_t, furrow_msgs::msg::DecisionKind> decisions_;  ///< of the newest plan
  std::set<std::int32_t> drawn_plants_;
  std::int32_t next_spray_ = 0;
};

}  // namespace furrow::components
