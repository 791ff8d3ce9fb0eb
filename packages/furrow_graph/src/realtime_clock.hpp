#pragma once

#include <chrono>

#include "furrow_core/time.hpp"

namespace furrow::graph {

/// Unix time at the start plus what the monotonic clock counted since: never steps.
class RealtimeClock {
 public:
  using Steady = std::chrono::steady_clock;

  RealtimeClock()
      : unix_start_(Time::from_nanoseconds(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                               std::chrono::system_clock::now().time_since_epoch())
                                               .count())),
        steady_start_(Steady::now()) {}

  [[nodiscard]] Time now() const {
    const auto since = Steady::now() - steady_start_;
    return unix_start_ + Duration::nanoseconds(
                             std::chrono::duration_cast<std::chrono::nanoseconds>(since).count());
  }
  [[nodiscard]] Steady::time_point steady(Time time) const {
    return steady_start_ + std::chrono::nanoseconds((time - unix_start_).count_ns());
  }

 private:
  Time unix_start_;
  Steady::time_point steady_start_;
};

}  // namespace furrow::graph
