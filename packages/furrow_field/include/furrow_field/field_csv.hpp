#pragma once

#include <string>
#include <string_view>

#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

/// A field as CSV (RFC 4180). First comment lines "# key: value" with name, source, length_m,
/// width_m and row_y_m; then a header with a unit in each column's name; then one line per plant.
/// Numbers read back bit-identical. Fails where validate() does.
[[nodiscard]] Result<std::string> to_csv(const FieldModel& field);

/// Columns in any order; kind, x_m and y_m are required. Other missing columns take Plant's
/// defaults (ids: counted from 0). A missing length or width becomes the smallest that contains the
/// plants.
///
/// Accepts the CSV of spreadsheets: a byte order mark, a line "sep=;", rows of separators only.
/// Cells may be separated by ';' or tabs; then the decimal mark may be a comma. The text must be
/// UTF-8. Errors (kParse, kOutOfRange) read "origin:line: column: message".
[[nodiscard]] Result<FieldModel> from_csv(std::string_view text, std::string_view origin);

}  // namespace furrow::field
