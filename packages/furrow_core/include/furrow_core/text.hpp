#pragma once

#include <string>
#include <vector>

namespace furrow {

/// `value` with this many decimals, whatever the locale: "0.00" for -0.001, "-" for NaN and
/// infinity.
[[nodiscard]] std::string fixed(double value, int decimals);

/// Lines of aligned columns, two spaces apart: the first column to the left, the others to the
/// right. Widths count bytes.
[[nodiscard]] std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace furrow
