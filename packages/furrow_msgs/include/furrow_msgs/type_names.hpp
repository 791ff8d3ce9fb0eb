#pragma once

#include <string>
#include <string_view>

namespace furrow::msgs {

/// `type_name` in either form: "pkg::msg::dds_::Type_" becomes "pkg/msg/Type"; other names stay.
[[nodiscard]] std::string ros_type_name(std::string_view type_name);
/// The inverse; names that are not "pkg/msg/Type" stay.
[[nodiscard]] std::string dds_type_name(std::string_view type_name);

}  // namespace furrow::msgs
