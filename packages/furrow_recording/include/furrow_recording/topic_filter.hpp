#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace furrow::recording {

/// True when the whole of `text` matches `pattern`: `*` matches any characters, also none and also
/// `/`; `?` matches one character; all others match themselves. Linear memory, at most
/// |pattern| |text| steps.
[[nodiscard]] bool matches_glob(std::string_view pattern, std::string_view text);

/// Selects topics by patterns. A leading "/" of patterns and topics does not count.
struct TopicFilter {
  std::vector<std::string> include = {"*"};
  std::vector<std::string> exclude;

  /// One of `include` matches and none of `exclude`.
  [[nodiscard]] bool accepts(std::string_view topic) const;
};

/// The patterns that match none of these topics: misspelled, most likely. "*" is never one.
[[nodiscard]] std::vector<std::string> unmatched_patterns(const std::vector<std::string>& patterns,
                                                          const std::vector<std::string>& topics);

}  // namespace furrow::recording
