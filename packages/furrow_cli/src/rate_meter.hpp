#pragma once

#include <cstddef>
#include <deque>
#include <optional>

#include "furrow_core/time.hpp"

namespace furrow::cli {

/// Rate and bandwidth of messages over a sliding window.
class RateMeter {
 public:
  struct Rate {
    double hz = 0.0;
    double bytes_per_s = 0.0;
    double mean_bytes = 0.0;
    double span_s = 0.0;  ///< from the first to the last message that counts
  };

  /// @pre window > 0
  explicit RateMeter(Duration window) : window_(window) {}

  /// Times are those of one clock and do not fall.
  void add(Time now, std::size_t bytes);
  /// Nothing while the window holds fewer than two messages.
  [[nodiscard]] std::optional<Rate> rate() const;
  /// Whether several messages came, and never two within one window: then there will be no rate.
  /// The time between the last two messages.
  [[nodiscard]] std::optional<Duration> period_beyond_window() const;

 private:
  struct Entry {
    Time time;
    std::size_t bytes = 0;
  };
  static constexpr int kTries = 3;  ///< messages after which the window counts as too short

  Duration window_;
  std::deque<Entry> entries_;
  Duration last_period_;
  int messages_ = 0;
  bool had_rate_ = false;
};

}  // namespace furrow::cli
