#include "furrow_actuation/ground_progress.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::actuation {

void GroundProgress::add(const BaseState& base) {
  constexpr double kLongestGap_s = 0.5;
  if (last_ && base.stamp <= last_->stamp) return;
  if (last_) {
    const double gap_s = std::min(kLongestGap_s, (base.stamp - last_->stamp).to_seconds());
    const double way_m = 0.5 * (last_->twist_B.vx_mps + base.twist_B.vx_mps) * gap_s;
    behind_m_ = std::max(0.0, behind_m_ - way_m);
  }
  last_ = base;
  const bool stands = std::abs(base.twist_B.vx_mps) < kStandingSpeed_mps;
  if (stands && !stood_since_) stood_since_ = base.stamp;
  if (!stands && stood_since_) {
    if (pauses_.size() == kMaxPauses) pauses_.erase_front();
    pauses_.push_back({*stood_since_, base.stamp});
    stood_since_.reset();
  }
}

double GroundProgress::motion_s(Time since, Time now) const {
  const auto overlap_s = [&](Time from, Time to) {
    return std::max(0.0, (std::min(to, now) - std::max(from, since)).to_seconds());
  };
  double stood_s = stood_since_ ? overlap_s(*stood_since_, now) : 0.0;
  for (const Pause& pause : pauses_) stood_s += overlap_s(pause.from, pause.to);
  return (now - since).to_seconds() - stood_s;
}

}  // namespace furrow::actuation
