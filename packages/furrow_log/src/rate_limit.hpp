#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_log/level.hpp"

namespace furrow::log {

/// Limits the lines of one component. Bounded: it remembers kMaxTexts texts. Depends on the times
/// and texts of its calls only. Not thread-safe.
class RateLimit {
 public:
  static constexpr std::size_t kMaxTexts = 64;

  struct Suppressed {
    Level level = Level::kInfo;
    std::string message;  ///< the newest of them; empty: different texts
    std::uint64_t count = 0;
  };

  RateLimit(Duration repeat_period, int max_lines_per_s)
      : repeat_period_(repeat_period), max_lines_per_s_(max_lines_per_s) {}

  /// How many lines of this text were suppressed since the last that was written; nothing: this one
  /// is suppressed too.
  [[nodiscard]] std::optional<std::uint64_t> admit(Time now, Level level, std::string_view message);
  /// Takes out what was suppressed and not told yet, in the order of level and text.
  [[nodiscard]] std::vector<Suppressed> take_suppressed();
  /// As take_suppressed(), but only lines beyond max_lines_per_s of an earlier second.
  [[nodiscard]] std::uint64_t take_excess(Time now);

 private:
  struct Text {
    Time written;
    std::string newest;
    std::uint64_t suppressed = 0;
  };
  void make_room();

  Duration repeat_period_;
  int max_lines_per_s_;
  std::map<std::pair<Level, std::string>, Text> texts_;  ///< by the text without its digits
  Time second_;                                          ///< start of the current one
  int lines_ = 0;                                        ///< in it
  std::uint64_t excess_ = 0;
};

}  // namespace furrow::log
