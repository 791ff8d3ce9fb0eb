// The only source that includes spdlog.
#include <spdlog/details/log_msg.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/rotating_file_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <unistd.h>

#include <chrono>
#include <system_error>

#include "furrow_core/text.hpp"
#include "furrow_log/sinks.hpp"

namespace furrow::log {
namespace {

constexpr std::size_t kMaxFileBytes = 10U << 20;
constexpr std::size_t kOlderFiles = 1;

spdlog::level::level_enum to_spdlog(Level level) {
  switch (level) {
    case Level::kDebug:
      return spdlog::level::debug;
    case Level::kInfo:
      return spdlog::level::info;
    case Level::kWarn:
      return spdlog::level::warn;
    case Level::kError:
      return spdlog::level::err;
    case Level::kFatal:
      break;
  }
  return spdlog::level::critical;
}

const char* padded(spdlog::level::level_enum level) {
  switch (level) {
    case spdlog::level::debug:
      return "DEBUG";
    case spdlog::level::info:
      return "INFO ";
    case spdlog::level::warn:
      return "WARN ";
    case spdlog::level::err:
      return "ERROR";
    default:
      return "FATAL";
  }
}

void append(std::string_view text, spdlog::memory_buf_t& to) {
  to.append(text.data(), text.data() + text.size());
}

/// Our words for the levels.
class LevelFlag final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& to) override {
    append(padded(message.level), to);
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<LevelFlag>();
  }
};

/// Seconds of simulated time.
class SecondsFlag final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& to) override {
    const std::chrono::duration<double> time = message.time.time_since_epoch();
    const std::string seconds = fixed(time.count(), 3);
    constexpr std::size_t kWidth = 9;
    append(std::string(kWidth - std::min(kWidth, seconds.size()), ' ') + seconds + " s", to);
  }
  [[nodiscard]] std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<SecondsFlag>();
  }
};

std::unique_ptr<spdlog::formatter> make_formatter(Clock clock, const std::string& before) {
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<LevelFlag>('K').add_flag<SecondsFlag>('Q');
  const std::string time = clock == Clock::kUnix ? "%Y-%m-%d %H:%M:%S.%e" : "%Q";
  formatter->set_pattern(before + time + " %^%K%$ %n: %v");
  return formatter;
}

class SpdlogSink final : public Sink {
 public:
  explicit SpdlogSink(std::shared_ptr<spdlog::sinks::sink> sink) : sink_(std::move(sink)) {}

  bool write(const Line& line) override {
    const spdlog::log_clock::time_point time{
        std::chrono::duration_cast<spdlog::log_clock::duration>(
            std::chrono::nanoseconds(line.time.count_ns()))};
    const std::string text = text_of(line);
    const spdlog::details::log_msg message(time, {}, line.component, to_spdlog(line.level), text);
    try {
      sink_->log(message);
      return true;
    } catch (const spdlog::spdlog_ex&) {
      return false;
    }
  }
  void flush() override {
    try {
      sink_->flush();
    } catch (const spdlog::spdlog_ex&) {
      // Of a full disk; its lines fail, and are counted, one by one.
    }
  }

 private:
  std::shared_ptr<spdlog::sinks::sink> sink_;
};

}  // namespace

std::shared_ptr<Sink> make_console_sink(Clock clock) {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_st>();
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  sink->set_formatter(make_formatter(clock, terminal ? "\r\033[K" : ""));
  return std::make_shared<SpdlogSink>(std::move(sink));
}

std::filesystem::path older_log(const std::filesystem::path& path) {
  const std::string name = path.stem().string() + ".1" + path.extension().string();
  return path.parent_path() / name;
}

Result<std::shared_ptr<Sink>> make_file_sink(const std::filesystem::path& path, Clock clock,
                                             FileStart start) {
  if (start == FileStart::kReplace) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
    std::filesystem::remove(older_log(path), ignored);
  }
  try {
    auto sink = std::make_shared<spdlog::sinks::rotating_file_sink_st>(path.string(), kMaxFileBytes,
                                                                       kOlderFiles);
    sink->set_formatter(make_formatter(clock, ""));
    return std::shared_ptr<Sink>(std::make_shared<SpdlogSink>(std::move(sink)));
  } catch (const spdlog::spdlog_ex& failure) {
    return Error{ErrorCode::kIo, "the log cannot be written: " + std::string(failure.what())};
  }
}

}  // namespace furrow::log
