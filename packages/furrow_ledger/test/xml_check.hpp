#pragma once

#include <string>
#include <string_view>
#include <vector>

/// A strict reader of the XML that Markup writes: the name of the fault, or empty. Knows elements,
/// double-quoted attributes, text and the entities of escape(); no comments, no CDATA.
inline std::string xml_fault(std::string_view text) {
  std::vector<std::string> open;
  std::size_t i = 0;
  bool seen_root = false;
  while (i < text.size()) {
    if (text[i] != '<') {
      if (text[i] == '&') {
        const std::size_t end = text.find(';', i);
        if (end == std::string_view::npos || end - i > 6) return "bad entity";
        i = end;
      } else if (text[i] == '>') {
        return "stray >";
      } else if (open.empty() && text[i] != '\n') {
        return "text outside the root";
      }
      ++i;
      continue;
    }
    const std::size_t end = text.find('>', i);
    if (end == std::string_view::npos) return "unclosed tag";
    std::string_view tag = text.substr(i + 1, end - i - 1);
    if (tag.find('<') != std::string_view::npos) return "< inside a tag";
    i = end + 1;
    if (tag.starts_with("/")) {
      if (open.empty() || open.back() != tag.substr(1)) return "closes " + std::string(tag);
      open.pop_back();
      continue;
    }
    if (open.empty() && seen_root) return "two roots";
    seen_root = true;
    const bool empty = tag.ends_with("/");
    if (empty) tag.remove_suffix(1);
    std::size_t quotes = 0;
    for (const char c : tag) quotes += c == '"';
    if (quotes % 2 != 0) return "unbalanced quotes";
    if (!empty) open.emplace_back(tag.substr(0, tag.find(' ')));
  }
  if (!open.empty()) return "leaves open " + open.back();
  return seen_root ? "" : "no element";
}
