#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace furrow::field {

/// The separator of a header line: ';' or a tab where the line has one and no comma outside quotes,
/// as spreadsheets write it where the comma is the decimal mark; else ','.
[[nodiscard]] char csv_separator(std::string_view header);

/// One line's cells (RFC 4180, lines without line breaks); nothing when a quote does not close or
/// text follows it.
[[nodiscard]] std::optional<std::vector<std::string>> csv_cells(std::string_view line,
                                                                char separator);

/// Without spaces and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// What is wrong with the bytes of a text file that is to be UTF-8, in words for its owner; empty
/// when nothing is. Takes a byte order mark off the front of `text`.
[[nodiscard]] std::string take_byte_order_mark(std::string_view& text);

}  // namespace furrow::field
