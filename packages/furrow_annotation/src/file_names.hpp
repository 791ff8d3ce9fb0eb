#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace furrow::annotation {

/// `path` relative to `folder` when it is below it; else unchanged.
[[nodiscard]] std::string relative_to(const std::filesystem::path& path,
                                      const std::filesystem::path& folder);

/// Each byte that is not plain printable ASCII as %XX, and '%' too (RFC 3986, section 2.1).
[[nodiscard]] std::string percent_encoded(std::string_view bytes);
/// Nothing where a '%' is not followed by two hexadecimal digits.
[[nodiscard]] std::optional<std::string> percent_decoded(std::string_view text);

}  // namespace furrow::annotation
