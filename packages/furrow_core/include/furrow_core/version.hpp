#pragma once

#include <string_view>

namespace furrow {

/// The version of Furrow that was built, as "0.1.0". Reports state it.
[[nodiscard]] std::string_view version();

}  // namespace furrow
