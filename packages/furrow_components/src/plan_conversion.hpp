#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "furrow_components/conversions.hpp"
#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_planning/types.hpp"
#include "lateral_axis.hpp"

namespace furrow::components {

/// The enumeration of the message for a decision of the planner.
[[nodiscard]] msgs::DecisionKind decision_kind(planning::Decision decision);

/// Translates plans into messages, and numbers their revisions and stops.
class PlanConversion {
 public:
  explicit PlanConversion(std::vector<LateralAxis> axes) : axes_(std::move(axes)) {}

  /// Notes when a track was seen last. Messages give this time for the target of each stop.
  void seen(std::int64_t track, Time last_seen);
  /// The routes and the decisions about their targets, as of a pose of the base. The message gets
  /// the stamp of the tracks.
  [[nodiscard]] furrow_msgs::msg::Plan to_msg(const planning::Plan& plan, const BaseOdometry& base,
                                              const builtin_interfaces::msg::Time& stamp);
  /// `axis` is an index in the tool; -1: none.
  [[nodiscard]] furrow_msgs::msg::Decision to_msg(Time stamp, planning::TargetId id,
                                                  msgs::DecisionKind decision,
                                                  std::int32_t axis = -1) const;

 private:
  [[nodiscard]] furrow_msgs::msg::Stop to_msg(const planning::Plan& plan,
                                              const planning::Stop& stop, const LateralAxis& axis,
                                              const BaseOdometry& base);

  std::vector<LateralAxis> axes_;
  std::map<std::int64_t, Time> last_seen_;  ///< by track; bounded, the oldest tracks go first
  std::uint64_t revision_ = 0;
  std::int64_t stop_id_ = 0;
};

}  // namespace furrow::components
