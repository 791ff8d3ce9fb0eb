#include "furrow_recording/topic_filter.hpp"

#include <algorithm>

namespace furrow::recording {
namespace {

std::string_view without_slash(std::string_view name) {
  return name.starts_with('/') && !name.starts_with("//") ? name.substr(1) : name;
}

bool any_matches(const std::vector<std::string>& patterns, std::string_view topic) {
  return std::any_of(patterns.begin(), patterns.end(), [topic](const std::string& pattern) {
    return matches_glob(without_slash(pattern), topic);
  });
}

}  // namespace

bool matches_glob(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  // Where to go on when what follows the last star does not fit: one character further.
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
  topic = without_slash(topic);
  return any_matches(include, topic) && !any_matches(exclude, topic);
}

}  // namespace furrow::recording
