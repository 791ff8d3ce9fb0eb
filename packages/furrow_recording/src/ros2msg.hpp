#pragma once

#include <string>
#include <string_view>

#include "furrow_core/result.hpp"

namespace furrow::recording {

/// The ROS 2 message definition of `ros_name` ("pkg/msg/Type") and of all types in it, in MCAP's
/// form ("ros2msg": each further type behind a line of 80 "=" and one of "MSG: pkg/Type"), from an
/// OMG IDL text. kParse: furrow::msgs::IdlSchema does not support the text.
/// kNotFound: the text has no such type.
[[nodiscard]] Result<std::string> ros2msg_from_idl(std::string_view idl, std::string_view ros_name);

}  // namespace furrow::recording
