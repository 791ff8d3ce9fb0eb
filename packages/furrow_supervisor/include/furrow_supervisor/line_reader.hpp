#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::supervisor {

/// Cuts a stream of bytes that comes in pieces into lines. A line that is longer than the limit is
/// cut into several; no byte is lost.
class LineReader {
 public:
  static constexpr std::size_t kLongestLine = 4096;

  LineReader() = default;
  explicit LineReader(std::size_t longest_line) : longest_line_(longest_line) {}

  /// The lines that this piece completes, without their newlines.
  [[nodiscard]] std::vector<std::string> add(std::string_view piece);
  /// What came since the last newline; nothing when there is none. For the end of the stream.
  [[nodiscard]] std::optional<std::string> take_rest();

 private:
  std::size_t longest_line_ = kLongestLine;
  std::string line_;
};

}  // namespace furrow::supervisor
