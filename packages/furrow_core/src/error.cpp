#include "furrow_core/error.hpp"

namespace furrow {
namespace {

std::string format(const SourceLocation& where, std::string_view key, std::string_view message) {
  std::string text;
  if (!where.file.empty()) {
    text += where.file;
    if (where.line > 0) text += ":" + std::to_string(where.line);
    text += ": ";
  }
  if (!key.empty()) text.append(key).append(": ");
  return text.append(message);
}

}  // namespace

std::string_view to_string(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidArgument:
      return "invalid argument";
    case ErrorCode::kOutOfRange:
      return "out of range";
    case ErrorCode::kParse:
      return "parse error";
    case ErrorCode::kNotFound:
      return "not found";
    case ErrorCode::kIo:
      return "input/output error";
    case ErrorCode::kStale:
      return "stale";
    case ErrorCode::kNoSolution:
      return "no solution";
    case ErrorCode::kUnavailable:
      return "unavailable";
  }
  return "unknown";
}

ConfigError::ConfigError(const SourceLocation& where, std::string_view key,
                         std::string_view message)
    : std::runtime_error(format(where, key, message)) {}

ConfigError::ConfigError(std::string_view message) : std::runtime_error(std::string(message)) {}

}  // namespace furrow
