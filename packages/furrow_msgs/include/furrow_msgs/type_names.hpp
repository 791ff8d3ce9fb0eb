#pragma once

#include <string>
#include <string_view>

namespace furrow::msgs {

/// `type_name` in either form: "pkg::msg::dds_::Type_" becomes "pkg/msg/Type"; others stay.
[[nodiscard]] std::string ros_type_name(std::string_view type_name);
/// The other way round; names that are not "pkg/msg/Type" stay.
[[nodiscard]] std::string dds_type_name(std::string_view type_name);

}  // namespace furrow::msgs
