#pragma once

#include <string>
#include <string_view>

#include "furrow_core/result.hpp"

namespace furrow::recording {

/// The ROS 2 message definition of `ros_name` ("pkg/msg/Type") and of all types in it, in MCAP's
/// form ("ros2msg": each further type behind a line of 80 "=" and one of "MSG: pkg/Type"), from an
/// OMG IDL text of modules and structs. kParse for IDL that has no like in ROS 2 messages,
/// kNotFound for a type that the text does not hold.
[[nodiscard]] Result<std::string> ros2msg_from_idl(std::string_view idl, std::string_view ros_name);

}  // namespace furrow::recording
