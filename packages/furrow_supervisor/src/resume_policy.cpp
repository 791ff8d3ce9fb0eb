#include "furrow_supervisor/resume_policy.hpp"

#include "furrow_actuation/safety_rules.hpp"

namespace furrow::supervisor {
namespace {

bool is_lost_peer(msgs::SafetyCause cause) {
  const auto known = actuation::safety_cause(msgs::to_string(cause));
  return known && actuation::rule_of(*known).lost_peer;
}

}  // namespace

void ResumePolicy::take(const furrow_msgs::msg::AxisState& state) {
  if (!axes_.contains(state.axis()) && axes_.size() == kMostAxes) return;
  Axis& axis = axes_[state.axis()];
  axis.lost.clear();
  for (const auto& latched : state.latched()) {
    const auto cause = msgs::from_msg(latched);
    if (cause.ok() && is_lost_peer(*cause)) axis.lost.push_back(*cause);
  }
}

std::vector<furrow_msgs::msg::ToolReset> ResumePolicy::due(Clock::time_point now) {
  std::vector<furrow_msgs::msg::ToolReset> resets;
  for (auto& [name, axis] : axes_) {
    const bool waits = axis.last_reset && now - *axis.last_reset < kBetweenResets;
    if (axis.lost.empty() || waits) continue;
    axis.last_reset = now;
    for (const msgs::SafetyCause cause : axis.lost) {
      auto& reset = resets.emplace_back();
      reset.axis(name);
      reset.cause(msgs::to_msg(cause));
    }
  }
  return resets;
}

}  // namespace furrow::supervisor
