#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::field {

/// The separator of a header line: ',' when it has one outside quotes, else ';' or a tab when it
/// has one, else ','. Spreadsheets write ';' where the comma is the decimal mark.
[[nodiscard]] char csv_separator(std::string_view header);

/// One line's cells (RFC 4180, no line breaks within cells). Empty when a quote does not close or
/// text follows it.
[[nodiscard]] std::optional<std::vector<std::string>> csv_cells(std::string_view line,
                                                                char separator);

/// Removes a UTF-8 byte order mark from the front of `text`. Returns "LINE: message" for the user
/// when the text is not UTF-8, else an empty string.
[[nodiscard]] std::string take_byte_order_mark(std::string_view& text);

}  // namespace furrow::field
