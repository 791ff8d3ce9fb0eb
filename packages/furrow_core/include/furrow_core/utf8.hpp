#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace furrow {

/// Offset of the first byte that is not part of well-formed UTF-8; empty when all are. Well-formed
/// by RFC 3629: no surrogates, no overlong forms, at most U+10FFFF.
[[nodiscard]] std::optional<std::size_t> first_invalid_utf8(std::string_view text);
[[nodiscard]] inline bool is_utf8(std::string_view text) {
  return !first_invalid_utf8(text);
}

/// The text with U+FFFD in place of each byte that is not well-formed. For display only: the result
/// no longer names the same file.
[[nodiscard]] std::string with_valid_utf8(std::string_view text);

}  // namespace furrow
