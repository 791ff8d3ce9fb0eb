#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace furrow {

enum class ErrorCode {
  kInvalidArgument,  ///< a value that the caller must correct
  kOutOfRange,       ///< a value outside its documented range
  kParse,            ///< a file or message that does not follow its format
  kNotFound,         ///< a file, name or key that does not exist
  kIo,               ///< the operating system failed to read or write
  kStale,            ///< data older than its use allows
  kNoSolution,       ///< the problem has no solution
  kUnavailable,      ///< a device, peer or feature that does not respond now
};

[[nodiscard]] std::string_view to_string(ErrorCode code);

/// A failure as data. `message` is one sentence for the user, without a final newline.
struct Error {
  ErrorCode code = ErrorCode::kInvalidArgument;
  std::string message;
};

/// Source of a configuration value. `line` counts from 1; 0: unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
};

/// Bad configuration or wiring, detected at construction. what() reads "file:line: key: message".
class ConfigError : public std::runtime_error {
 public:
  ConfigError(const SourceLocation& where, std::string_view key, std::string_view message);
  explicit ConfigError(std::string_view message);
};

}  // namespace furrow
