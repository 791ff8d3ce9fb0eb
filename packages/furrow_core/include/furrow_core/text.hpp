#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace furrow {

/// `value` with this many decimals, whatever the locale: "0.00" for -0.001, "-" for NaN and
/// infinity.
[[nodiscard]] std::string fixed(double value, int decimals);

/// Lines of aligned columns, two spaces apart: the first column to the left, the others to the
/// right. Widths count bytes.
[[nodiscard]] std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// `text` without `blanks` at either end.
[[nodiscard]] std::string_view trimmed(std::string_view text, std::string_view blanks = " \t");

/// The end of an error about an unknown name: "; did you mean 'detector'?" with the nearest of
/// `candidates`, or nothing where none is near.
[[nodiscard]] std::string did_you_mean(const std::string& name,
                                       const std::vector<std::string>& candidates);

}  // namespace furrow
