#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace furrow::recording {

/// True when the whole of `text` matches `pattern`: `*` stands for any characters, also none and
/// also `/`; `?` for one; everything else for itself. Linear memory, at most |pattern| |text|
/// steps.
[[nodiscard]] bool matches_glob(std::string_view pattern, std::string_view text);

/// Topics by patterns. A leading "/" of patterns and topics is left out of the comparison.
struct TopicFilter {
  std::vector<std::string> include = {"*"};
  std::vector<std::string> exclude;

  /// One of `include` matches and none of `exclude`.
  [[nodiscard]] bool accepts(std::string_view topic) const;
};

}  // namespace furrow::recording
