#pragma once

#include "furrow_log/log.hpp"

namespace furrow::cli {

/// While it lives, messages of OpenCV are lines of a log, as component "opencv"; at other times
/// they go to standard error, one line each. OpenCV has one log per process: make one of these at a
/// time.
class OpenCvLog {
 public:
  explicit OpenCvLog(log::Log& log);
  ~OpenCvLog();
  OpenCvLog(const OpenCvLog&) = delete;
  OpenCvLog& operator=(const OpenCvLog&) = delete;
};

}  // namespace furrow::cli
