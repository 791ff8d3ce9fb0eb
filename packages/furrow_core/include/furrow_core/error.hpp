#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

namespace furrow {

enum class ErrorCode {
  kInvalidArgument,  ///< a value that the caller must mend
  kOutOfRange,       ///< a value outside its documented range
  kParse,            ///< a file or message that does not follow its format
  kNotFound,         ///< a file, name or key that is not there
  kIo,               ///< the operating system refused to read or write
  kStale,            ///< data older than its use allows
  kNoSolution,       ///< the problem as posed has no answer
  kUnavailable,      ///< a device, peer or feature that does not answer now
};

[[nodiscard]] std::string_view to_string(ErrorCode code);

/// What went wrong, as data. `message` is one sentence for a person, without a final newline.
struct Error {
  ErrorCode code = ErrorCode::kInvalidArgument;
  std::string message;
};

/// Where a configuration value stands. `line` counts from 1; 0 where there is none.
struct SourceLocation {
  std::string file;
  int line = 0;
};

/// Bad configuration or wiring, found at construction. what() reads "file:line: key: message".
class ConfigError : public std::runtime_error {
 public:
  ConfigError(const SourceLocation& where, std::string_view key, std::string_view message);
  explicit ConfigError(std::string_view message);
};

}  // namespace furrow
