#pragma once

#include "furrow_log/log.hpp"

namespace furrow::dds {

/// While it lives, messages of the Fast DDS library are lines of a log, as component "fastdds"; at
/// other times they go to standard error. Fast DDS has one log per process: make one of these at a
/// time.
class LogRedirect {
 public:
  explicit LogRedirect(log::Log& log);
  ~LogRedirect();
  LogRedirect(const LogRedirect&) = delete;
  LogRedirect& operator=(const LogRedirect&) = delete;
};

}  // namespace furrow::dds
