#pragma once

#include <string>
#include <string_view>

#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

/// A field as CSV (RFC 4180): comment lines "# key: value" with name, source, length_m, width_m and
/// row_y_m, then a header that names each column with its unit, then a line per plant. Numbers are
/// written so that reading gives back the same bits. Fails where validate() does.
[[nodiscard]] Result<std::string> to_csv(const FieldModel& field);

/// Columns in any order; kind, x_m and y_m are required. What else is missing takes Plant's default
/// (ids: counted from 0); a missing length or width is the least that holds the plants.
///
/// Reads what spreadsheets write: a byte order mark, a line "sep=;", ';' or tabs between the cells,
/// then also a comma as decimal mark, and rows of separators alone. The text is UTF-8. Errors
/// (kParse, kOutOfRange) read "origin:line: column: what is wrong".
[[nodiscard]] Result<FieldModel> from_csv(std::string_view text, std::string_view origin);

}  // namespace furrow::field
