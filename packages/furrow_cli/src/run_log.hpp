#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "furrow_dds/log_redirect.hpp"
#include "furrow_launch/run_options.hpp"
#include "furrow_log/log.hpp"
#include "furrow_log/sinks.hpp"
#include "opencv_log.hpp"

namespace furrow::cli {

/// The log of a run: on the console and in the folder of its report, with the messages of Fast DDS
/// and OpenCV.
class RunLog {
 public:
  /// Writes into launch::log_file() of `folder`, which is made. `process` is empty where the run
  /// has only one. `start`: whether the process may have been restarted. Throws ConfigError: a
  /// level is malformed, or the file cannot be written.
  RunLog(const launch::RunOptions& options, const std::filesystem::path& folder,
         const std::string& process, log::FileStart start);
  /// Says on standard error how many lines were lost, if any were. Where the run did not start, it
  /// removes the file and folder that it made.
  ~RunLog();
  RunLog(const RunLog&) = delete;
  RunLog& operator=(const RunLog&) = delete;

  [[nodiscard]] log::Log& log() { return log_; }
  /// From here on the file stays.
  void run_started() { started_ = true; }
  /// A line of the command itself.
  void write(log::Level level, std::string_view message);
  /// The same, at a time of the graph's clock.
  void write(Time time, log::Level level, std::string_view message);

 private:
  std::filesystem::path file_;
  bool made_file_ = false;
  bool made_folder_ = false;
  bool started_ = false;
  log::Log log_;
  dds::LogRedirect fast_dds_;
  OpenCvLog opencv_;
};

}  // namespace furrow::cli
