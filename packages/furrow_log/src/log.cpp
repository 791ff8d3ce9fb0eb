#include "furrow_log/log.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "priority_mutex.hpp"
#include "queued_writer.hpp"
#include "rate_limit.hpp"
#include "sink_list.hpp"

namespace furrow::log {
namespace {

constexpr std::size_t kMaxMessage = 2000;
constexpr std::size_t kMaxComponents = 1000;

std::string one_line(std::string_view message) {
  std::string text(message.substr(0, kMaxMessage));
  if (message.size() > kMaxMessage) text += "...";
  std::ranges::replace_if(
      text, [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

std::string more(std::uint64_t count) {
  return std::to_string(count) + (count == 1 ? " more line" : " more lines");
}

}  // namespace

std::string text_of(const Line& line) {
  if (line.repeated == 0) return line.message;
  return line.message + " (" + std::to_string(line.repeated) + " more of these)";
}

struct Log::Impl {
  explicit Impl(LogOptions o) : options(std::move(o)) {
    if (options.order == Order::kArrival) writer.emplace(sinks);
  }

  /// @pre mutex is held.
  RateLimit& limit_of(const std::string& component) {
    const bool room = limits.size() < kMaxComponents || limits.contains(component);
    return limits.try_emplace(room ? component : "", options.repeat_period, options.max_lines_per_s)
        .first->second;
  }

  /// @pre mutex is held.
  void admit(Line line) {
    RateLimit& limit = limit_of(line.component);
    if (const std::uint64_t excess = limit.take_excess(line.time); excess > 0) {
      pass_on({line.time, Level::kWarn, line.component, more(excess) + " suppressed"});
    }
    const auto repeated = limit.admit(line.time, line.level, line.message);
    if (!repeated) {
      ++counters.suppressed;
      return;
    }
    line.repeated = *repeated;
    pass_on(std::move(line));
  }

  /// @pre mutex is held.
  void pass_on(Line line) {
    if (writer) {
      if (writer->push(std::move(line))) ++counters.written;
      return;
    }
    ++counters.written;
    if (!same_time.empty() && same_time.front().time != line.time) write_same_time();
    same_time.push_back(std::move(line));
  }

  /// @pre mutex is held.
  void write_same_time() {
    std::ranges::stable_sort(same_time, {}, &Line::component);
    sinks.write(same_time);
    const auto severe = [](const Line& line) { return line.level >= Level::kWarn; };
    // A process that is killed leaves them.
    if (std::ranges::any_of(same_time, severe)) sinks.flush();
    same_time.clear();
  }

  void flush() {
    {
      const std::lock_guard lock(mutex);
      for (auto& [component, limit] : limits) {
        for (RateLimit::Suppressed& text : limit.take_suppressed()) {
          const std::string tail = more(text.count) + (text.message.empty() ? "" : " of: ");
          pass_on({newest, text.level, component, tail + text.message});
        }
      }
      if (!writer) write_same_time();
    }
    if (writer) writer->wait_until_written();
    sinks.flush();
  }

  LogOptions options;
  SinkList sinks;

  mutable PriorityMutex mutex;  ///< of limits to counters
  std::map<std::string, RateLimit> limits;
  std::vector<Line> same_time;  ///< Order::kTime: lines of the newest time
  Time newest;
  LogCounters counters;

  std::optional<QueuedWriter> writer;  ///< Order::kArrival
};

Log::Log(LogOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}
Log::~Log() {
  impl_->flush();
}

void Log::add(std::shared_ptr<Sink> sink) {
  impl_->sinks.add(std::move(sink));
}

void Log::remove(const Sink& sink) {
  flush();
  impl_->sinks.remove(sink);
}

bool Log::enabled(std::string_view component, Level level) const {
  return level >= impl_->options.levels.of(component);
}

void Log::write(Time time, Level level, std::string_view component, std::string_view message) {
  if (!enabled(component, level)) return;
  const std::lock_guard lock(impl_->mutex);
  impl_->newest = std::max(impl_->newest, time);
  impl_->admit({time, level, std::string(component), one_line(message)});
}

void Log::write_foreign(Level level, std::string_view library, std::string_view message) {
  if (!enabled(library, level)) return;
  const std::lock_guard lock(impl_->mutex);
  if (impl_->options.now) impl_->newest = std::max(impl_->newest, impl_->options.now());
  Line line{impl_->newest, level, std::string(library), one_line(message)};
  line.foreign = true;
  impl_->admit(std::move(line));
}

void Log::flush() {
  impl_->flush();
}

LogCounters Log::counters() const {
  const std::lock_guard lock(impl_->mutex);
  LogCounters counters = impl_->counters;
  counters.failed = impl_->sinks.failed();
  if (impl_->writer) counters.dropped = impl_->writer->dropped();
  return counters;
}

Time unix_time() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return Time::from_nanoseconds(std::chrono::nanoseconds(now).count());
}

}  // namespace furrow::log
