#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>

#include "furrow_geometry/tool_model.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/visualization_msgs.h"

namespace furrow::components {

/// Markers of a run for RViz, in the field frame. Plants are discs, coloured by class and decision.
/// Routes are lines through their aims, sprays are footprints at their landing. Bounded: plants are
/// deleted with their tracks, and a new spray replaces the oldest one.
class FieldMarkers {
 public:
  static constexpr std::int32_t kMaxSprays = 2000;

  /// Tracks with at least this crop probability are drawn as crop. The model is not kept.
  explicit FieldMarkers(const geometry::ToolModel& tool, double crop_threshold = 0.5);

  /// Every track that is not deleted, in namespace "plants". Markers of other tracks are deleted.
  [[nodiscard]] visualization_msgs::msg::MarkerArray plants(
      const furrow_msgs::msg::Tracks& message);
  /// A line per axis, in namespace "plan", deleted when its route is empty. The decisions colour
  /// the plants of later calls.
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
