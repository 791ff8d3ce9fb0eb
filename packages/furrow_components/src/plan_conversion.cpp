#include "plan_conversion.hpp"

#include <algorithm>
#include <optional>

#include "furrow_graph/stamp.hpp"

namespace furrow::components {

msgs::DecisionKind decision_kind(planning::Decision decision) {
  using msgs::DecisionKind;
  using planning::Decision;
  switch (decision) {
    case Decision::kTreat:
      return DecisionKind::kTreat;
    case Decision::kUnreachable:
    case Decision::kBehind:
      return DecisionKind::kUnreachable;
    case Decision::kLowPriority:
      return DecisionKind::kLowPriority;
    case Decision::kProtectedCrop:
      return DecisionKind::kProtectedCrop;
    case Decision::kOutside:
      return DecisionKind::kOutside;
    case Decision::kInvalid:
    case Decision::kDuplicate:
      return DecisionKind::kStale;
    case Decision::kAxisFault:
      break;
  }
  return DecisionKind::kFault;
}

void PlanConversion::seen(std::int64_t track, Time last_seen) {
  constexpr std::size_t kMostTracks = 20'000;
  last_seen_[track] = last_seen;
  if (last_seen_.size() > kMostTracks) last_seen_.erase(last_seen_.begin());
}

furrow_msgs::msg::Plan PlanConversion::to_msg(const planning::Plan& plan, const BaseOdometry& base,
                                              const builtin_interfaces::msg::Time& stamp) {
  furrow_msgs::msg::Plan message;
  message.header().stamp(stamp);
  message.header().frame_id(kFieldFrame);
  message.revision(++revision_);
  for (std::size_t i = 0; i < plan.routes.size(); ++i) {
    auto& route = message.routes().emplace_back();
    route.axis(axes_[i].model.name);
    for (const planning::Stop& stop : plan.routes[i]) {
      route.stops().push_back(to_msg(plan, stop, axes_[i], base));
    }
  }
  for (const planning::TargetDecision& decision : plan.decisions) {
    message.decisions().push_back(
        to_msg(base.stamp, decision.id, decision_kind(decision.decision), decision.axis));
  }
  return message;
}

furrow_msgs::msg::Stop PlanConversion::to_msg(const planning::Plan& plan,
                                              const planning::Stop& stop, const LateralAxis& axis,
                                              const BaseOdometry& base) {
  furrow_msgs::msg::Stop message;
  message.id(++stop_id_);
  message.aim(to_point(stop.aim_F));
  message.axis_position_m(axis.position_m(stop.position_m));
  const double speed_mps = std::max(base.speed_mps, 1e-3);
  message.expected(
      graph::to_msg(base.stamp + Duration::seconds((stop.robot_x_m - base.X_FB.x_m) / speed_mps)));
  message.while_moving(stop.moving);
  const auto targets = plan.targets_of(stop);
  message.track_ids().assign(targets.begin(), targets.end());
  // The aim is as old as the target that was not seen for longest. An unknown one was never seen.
  std::optional<Time> observed;
  for (const planning::TargetId id : targets) {
    const auto known = last_seen_.find(id);
    const Time last = known == last_seen_.end() ? Time() : known->second;
    observed = std::min(observed.value_or(last), last);
  }
  message.observed(graph::to_msg(observed.value_or(Time())));
  return message;
}

furrow_msgs::msg::Decision PlanConversion::to_msg(Time stamp, planning::TargetId id,
                                                  msgs::DecisionKind decision,
                                                  std::int32_t axis) const {
  furrow_msgs::msg::Decision message;
  message.stamp(graph::to_msg(stamp));
  message.track_id(id);
  message.decision(msgs::to_msg(decision));
  if (axis >= 0) message.axis(axes_[static_cast<std::size_t>(axis)].model.name);
  return message;
}

}  // namespace furrow::components
