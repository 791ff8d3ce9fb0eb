#include "furrow_recording/topic_filter.hpp"

#include <algorithm>

namespace furrow::recording {
namespace {

/// Also of "//NAME", a topic that is not of ROS.
std::string_view without_slashes(std::string_view name) {
  return name.substr(std::min(name.find_first_not_of('/'), name.size()));
}

bool matches(const std::string& pattern, std::string_view topic) {
  return matches_glob(without_slashes(pattern), without_slashes(topic));
}

bool any_matches(const std::vector<std::string>& patterns, std::string_view topic) {
  return std::ranges::any_of(
      patterns, [topic](const std::string& pattern) { return matches(pattern, topic); });
}

}  // namespace

bool matches_glob(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  // Where to resume when the pattern behind the last star does not match: one character further.
  std::size_t star = std::string_view::npos;
  std::size_t star_text = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      star_text = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++star_text;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string_view::npos;
}

bool TopicFilter::accepts(std::string_view topic) const {
  return any_matches(include, topic) && !any_matches(exclude, topic);
}

std::vector<std::string> unmatched_patterns(const std::vector<std::string>& patterns,
                                            const std::vector<std::string>& topics) {
  std::vector<std::string> unmatched;
  for (const std::string& pattern : patterns) {
    const bool used = pattern == "*" || std::ranges::any_of(topics, [&](const std::string& topic) {
                        return matches(pattern, topic);
                      });
    if (!used) {
      unmatched.push_back(pattern);
    }
  }
  return unmatched;
}

}  // namespace furrow::recording
