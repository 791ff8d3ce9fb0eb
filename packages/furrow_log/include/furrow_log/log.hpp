#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "furrow_core/time.hpp"
#include "furrow_log/level.hpp"

namespace furrow::log {

/// One line of the log.
struct Line {
  Time time;  ///< of the graph's clock
  Level level = Level::kInfo;
  std::string component;       ///< as in the graph; or the library that speaks, such as "fastdds"
  std::string message;         ///< one line of text
  std::uint64_t repeated = 0;  ///< lines of the same text that were suppressed before this one
  bool foreign = false;        ///< of write_foreign(): its time depends on the computer
};
/// The message with its repetitions: "text (12 more of these)".
[[nodiscard]] std::string text_of(const Line& line);

/// Where lines go. Called by one thread at a time.
class Sink {
 public:
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  virtual ~Sink() = default;
  /// False: the line could not be written.
  [[nodiscard]] virtual bool write(const Line& line) = 0;
  virtual void flush() {}
};

/// Which thread writes, and in which order.
enum class Order : std::uint8_t {
  kArrival,  ///< a thread of the log writes in the order of arrival; the caller never waits for
             ///< disk
  kTime,     ///< the caller writes. Lines of one time are sorted by component, then by arrival: the
             ///< order does not depend on threads where each component's lines do not.
};

/// Of the computer's clock, since 1970.
[[nodiscard]] Time unix_time();

struct LogOptions {
  Levels levels;
  Order order = Order::kArrival;
  /// Lines of one component that differ in digits only are written once in this time; the others
  /// are counted.
  Duration repeat_period = Duration::seconds(5.0);
  int max_lines_per_s = 50;  ///< of one component; further ones are counted
  /// The time of write_foreign(). None: that of the newest line.
  std::function<Time()> now = {};
};

struct LogCounters {
  std::uint64_t written = 0;
  std::uint64_t suppressed = 0;  ///< by the rate limits
  std::uint64_t dropped = 0;     ///< because the queue to the sinks was full
  std::uint64_t failed = 0;      ///< that a sink could not write
};

/// Takes lines from all components of a process, limits their rate and passes them to its sinks.
/// Thread-safe. Bounded: with Order::kArrival a full queue drops the newest line. Drops are
/// counted, and a line of the component "log" tells their number. write() then waits for no sink,
/// and its locks inherit the priority of the caller.
class Log {
 public:
  explicit Log(LogOptions options = {});
  /// Writes what is left, as flush() does.
  ~Log();
  Log(const Log&) = delete;
  Log& operator=(const Log&) = delete;

  void add(std::shared_ptr<Sink> sink);
  /// On return the sink is not called any more. Lines written before have reached it.
  void remove(const Sink& sink);

  /// Whether such a line would be written, but for the rate limits. Cheap.
  [[nodiscard]] bool enabled(std::string_view component, Level level) const;
  /// Control characters in the text, such as line ends, are replaced by spaces.
  void write(Time time, Level level, std::string_view component, std::string_view message);
  /// For text that comes without a time, such as that of a library.
  void write_foreign(Level level, std::string_view library, std::string_view message);
  /// On return every sink has every line, and for each suppressed text a line with its count.
  void flush();
  [[nodiscard]] LogCounters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::log
