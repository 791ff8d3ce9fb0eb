#pragma once

#include <string>
#include <string_view>

#include "furrow_core/result.hpp"

namespace furrow::recording {

/// The ROS 2 message definition of `ros_name` ("pkg/msg/Type"), from an OMG IDL text. As in MCAP's
/// "ros2msg", the types that it uses follow. A line of 80 "=" and "MSG: pkg/Type" precede each
/// type. kParse: furrow::msgs::IdlSchema does not support the text. kNotFound: the text has no such
/// type.
[[nodiscard]] Result<std::string> ros2msg_from_idl(std::string_view idl, std::string_view ros_name);

}  // namespace furrow::recording
