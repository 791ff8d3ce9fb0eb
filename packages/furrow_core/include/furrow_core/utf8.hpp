#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace furrow {

/// Offset of the first byte that is not part of well-formed UTF-8 (RFC 3629: no surrogates, no
/// overlong forms, at most U+10FFFF); nothing when the text is well-formed.
[[nodiscard]] std::optional<std::size_t> first_invalid_utf8(std::string_view text);
[[nodiscard]] inline bool is_utf8(std::string_view text) {
  return !first_invalid_utf8(text);
}

/// The text with U+FFFD in place of each byte that is not well-formed: for people, not for use as a
/// name again.
[[nodiscard]] std::string with_valid_utf8(std::string_view text);

}  // namespace furrow
