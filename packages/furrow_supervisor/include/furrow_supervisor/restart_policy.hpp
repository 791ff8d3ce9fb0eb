#pragma once

#include <deque>
#include <optional>

#include "furrow_core/time.hpp"

namespace furrow::supervisor {

/// When a process that died is started again: after a delay that doubles with each death within a
/// window, and not at all after too many.
class RestartPolicy {
 public:
  static constexpr int kLimit = 5;
  static constexpr Duration kWindow = Duration::milliseconds(60'000);
  static constexpr Duration kFirstDelay = Duration::milliseconds(100);
  static constexpr Duration kLongestDelay = Duration::milliseconds(2'000);

  /// It died at `now`: the time to start it again, or nothing when it died more than kLimit times
  /// within kWindow.
  [[nodiscard]] std::optional<Time> after_death(Time now);

 private:
  std::deque<Time> deaths_;
};

}  // namespace furrow::supervisor
