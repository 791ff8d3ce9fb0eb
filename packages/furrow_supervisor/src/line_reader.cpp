#include "furrow_supervisor/line_reader.hpp"

#include <utility>

namespace furrow::supervisor {

std::vector<std::string> LineReader::add(std::string_view piece) {
  std::vector<std::string> lines;
  for (const char c : piece) {
    const bool ends = c == '\n';
    if (ends || line_.size() == longest_line_) lines.push_back(std::exchange(line_, {}));
    if (!ends) line_ += c;
  }
  return lines;
}

std::optional<std::string> LineReader::take_rest() {
  if (line_.empty()) return std::nullopt;
  return std::exchange(line_, {});
}

}  // namespace furrow::supervisor
