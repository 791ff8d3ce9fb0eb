#include "opencv_log.hpp"

#include <iostream>
#include <mutex>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <string>

namespace furrow::cli {
namespace {

// OpenCV has one log per process, so that its destination is one per process too.
std::mutex destination_mutex;
log::Log* destination = nullptr;  ///< null: standard error

void take(log::Level level, const std::string& text) {
  const std::lock_guard lock(destination_mutex);
  if (destination != nullptr) {
    destination->write_foreign(level, "opencv", text);
  } else {
    std::cerr << "opencv: " << text << '\n';
  }
}

log::Level level_of(cv::utils::logging::LogLevel level) {
  switch (level) {
    case cv::utils::logging::LOG_LEVEL_FATAL:
      return log::Level::kFatal;
    case cv::utils::logging::LOG_LEVEL_ERROR:
      return log::Level::kError;
    case cv::utils::logging::LOG_LEVEL_WARNING:
      return log::Level::kWarn;
    case cv::utils::logging::LOG_LEVEL_INFO:
      return log::Level::kInfo;
    default:
      return log::Level::kDebug;
  }
}

/// OpenCV throws after this call: the exception says the same to the caller.
int ignore_error(int, const char*, const char*, const char*, int, void*) {
  return 0;
}

}  // namespace

OpenCvLog::OpenCvLog(log::Log& log) {
  cv::redirectError(ignore_error);
  const std::lock_guard lock(destination_mutex);
  destination = &log;
}

OpenCvLog::~OpenCvLog() {
  cv::redirectError(nullptr);
  const std::lock_guard lock(destination_mutex);
  destination = nullptr;
}

}  // namespace furrow::cli

// OpenCV 4.6 has no call that redirects its log. Its libraries write through these two functions,
// and the dynamic linker takes the definitions of the program before those of libopencv_core.
namespace cv::utils::logging::internal {

void writeLogMessage(LogLevel level, const char* message) {
  furrow::cli::take(furrow::cli::level_of(level), message);
}

void writeLogMessageEx(LogLevel level, const char* tag, const char* /*file*/, int /*line*/,
                       const char* /*function*/, const char* message) {
  const std::string prefix = tag == nullptr ? std::string() : std::string(tag) + ": ";
  furrow::cli::take(furrow::cli::level_of(level), prefix + message);
}

}  // namespace cv::utils::logging::internal
