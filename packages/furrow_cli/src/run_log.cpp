#include "run_log.hpp"

#include <filesystem>
#include <iostream>
#include <system_error>

#include "furrow_core/error.hpp"

namespace furrow::cli {
namespace {

log::LogOptions log_options(const launch::RunOptions& options) {
  log::LogOptions result;
  for (const std::string& level : options.log_levels) result.levels.set(level);
  if (options.lockstep()) {
    result.order = log::Order::kTime;
  } else {
    result.now = log::unix_time;
  }
  return result;
}

}  // namespace

RunLog::RunLog(const launch::RunOptions& options, const std::filesystem::path& folder,
               const std::string& process, log::FileStart start)
    : file_(launch::log_file(folder, process)),
      log_(log_options(options)),
      fast_dds_(log_),
      opencv_(log_) {
  const auto clock = options.lockstep() ? log::Clock::kSimulated : log::Clock::kUnix;
  log_.add(log::make_console_sink(clock));
  std::error_code failure;
  made_folder_ = std::filesystem::create_directories(file_.parent_path(), failure);
  if (failure) throw ConfigError("--out: " + folder.string() + ": " + failure.message());
  made_file_ = !std::filesystem::exists(file_, failure);
  auto file = log::make_file_sink(file_, clock, start);
  if (!file.ok()) throw ConfigError("--out: " + folder.string() + ": " + file.error().message);
  log_.add(*file);
}

RunLog::~RunLog() {
  log_.flush();
  const log::LogCounters counters = log_.counters();
  if (const std::uint64_t lost = counters.dropped + counters.failed; lost > 0) {
    std::cerr << "furrow: " << lost << " lines of the log were lost\n";
  }
  if (started_ || !made_file_) return;
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
  if (made_folder_) std::filesystem::remove(file_.parent_path(), ignored);
}

void RunLog::write(log::Level level, std::string_view message) {
  log_.write_foreign(level, "furrow", message);
}

void RunLog::write(Time time, log::Level level, std::string_view message) {
  log_.write(time, level, "furrow", message);
}

}  // namespace furrow::cli
