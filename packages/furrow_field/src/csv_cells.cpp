#include "csv_cells.hpp"

#include <algorithm>
#include <cstdio>

#include "furrow_core/utf8.hpp"

namespace furrow::field {

char csv_separator(std::string_view header) {
  bool in_quotes = false;
  char found = ',';
  for (const char c : header) {
    if (c == '"') in_quotes = !in_quotes;
    if (in_quotes) continue;
    if (c == ',') return ',';
    if (found == ',' && (c == ';' || c == '\t')) found = c;
  }
  return found;
}

std::optional<std::vector<std::string>> csv_cells(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool in_quotes = false;
  bool closed = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (in_quotes) {
      if (c != '"') {
        cells.back() += c;
      } else if (i + 1 < line.size() && line[i + 1] == '"') {
        cells.back() += '"';
        ++i;
      } else {
        in_quotes = false;
        closed = true;
      }
    } else if (c == separator) {
      cells.emplace_back();
      closed = false;
    } else if (c == '"' && cells.back().empty() && !closed) {
      in_quotes = true;
    } else if (c == '"' || closed) {
      return std::nullopt;
    } else {
      cells.back() += c;
    }
  }
  if (in_quotes) return std::nullopt;
  return cells;
}

std::string take_byte_order_mark(std::string_view& text) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    return "1: the file is UTF-16: save it as \"CSV UTF-8\"";
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const auto bad = first_invalid_utf8(text);
  if (!bad) return {};
  const auto line =
      std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(*bad), '\n');
  char byte[8];
  std::snprintf(byte, sizeof byte, "0x%02X", static_cast<unsigned char>(text[*bad]));
  return std::to_string(line + 1) + ": the byte " + byte +
         " is not UTF-8: save the file as \"CSV UTF-8\", not in a national encoding";
}

}  // namespace furrow::field
