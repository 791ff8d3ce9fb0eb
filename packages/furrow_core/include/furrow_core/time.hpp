#pragma once

#include <cmath>
#include <compare>
#include <cstdint>

namespace furrow {

/// A span of time in whole nanoseconds.
class Duration {
 public:
  constexpr Duration() = default;

  [[nodiscard]] static constexpr Duration nanoseconds(std::int64_t ns) { return Duration(ns); }
  [[nodiscard]] static constexpr Duration milliseconds(std::int64_t ms) {
    return Duration(ms * 1'000'000);
  }
  /// Rounded to the nearest nanosecond. @pre |seconds| < 9.2e9.
  [[nodiscard]] static Duration seconds(double seconds) {
    return Duration(static_cast<std::int64_t>(std::llround(seconds * 1e9)));
  }

  [[nodiscard]] constexpr std::int64_t count_ns() const { return ns_; }
  [[nodiscard]] constexpr double to_seconds() const { return static_cast<double>(ns_) * 1e-9; }

  constexpr auto operator<=>(const Duration&) const = default;
  constexpr Duration operator-() const { return Duration(-ns_); }
  constexpr Duration operator+(Duration other) const { return Duration(ns_ + other.ns_); }
  constexpr Duration operator-(Duration other) const { return Duration(ns_ - other.ns_); }
  constexpr Duration operator*(std::int64_t factor) const { return Duration(ns_ * factor); }

 private:
  explicit constexpr Duration(std::int64_t ns) : ns_(ns) {}
  std::int64_t ns_ = 0;
};

/// An instant: nanoseconds since the epoch of the clock in use (Unix epoch in real time, start of
/// the run in simulation). Instants of different clocks do not compare meaningfully.
class Time {
 public:
  constexpr Time() = default;

  [[nodiscard]] static constexpr Time from_nanoseconds(std::int64_t ns) { return Time(ns); }
  [[nodiscard]] static Time from_seconds(double seconds) {
    return Time(Duration::seconds(seconds).count_ns());
  }

  [[nodiscard]] constexpr std::int64_t count_ns() const { return ns_; }
  [[nodiscard]] constexpr double to_seconds() const { return static_cast<double>(ns_) * 1e-9; }

  constexpr auto operator<=>(const Time&) const = default;
  constexpr Time operator+(Duration d) const { return Time(ns_ + d.count_ns()); }
  constexpr Time operator-(Duration d) const { return Time(ns_ - d.count_ns()); }
  constexpr Duration operator-(Time other) const { return Duration::nanoseconds(ns_ - other.ns_); }
  constexpr Time& operator+=(Duration d) {
    ns_ += d.count_ns();
    return *this;
  }

 private:
  explicit constexpr Time(std::int64_t ns) : ns_(ns) {}
  std::int64_t ns_ = 0;
};

}  // namespace furrow
