#include "furrow_supervisor/restart_policy.hpp"

#include <algorithm>

namespace furrow::supervisor {

std::optional<Time> RestartPolicy::after_death(Time now) {
  while (!deaths_.empty() && now - deaths_.front() > kWindow) deaths_.pop_front();
  deaths_.push_back(now);
  const auto deaths = static_cast<int>(deaths_.size());
  if (deaths > kLimit) return std::nullopt;
  return now + std::min(kFirstDelay * (std::int64_t{1} << (deaths - 1)), kLongestDelay);
}

}  // namespace furrow::supervisor
