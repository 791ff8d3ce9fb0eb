#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_msgs/idl_schema.hpp"

namespace furrow::msgs {

/// One IDL file and the structs that it defines itself, in their order.
struct IdlFile {
  std::string stem;                ///< "sensor_msgs"
  std::string module;              ///< of all its structs: "sensor_msgs" of sensor_msgs::msg::Image
  std::vector<std::string> names;  ///< without their scope: "Image"
  std::string text;                ///< with the included files before it, without comments
  IdlSchema schema;                ///< of the file and the included ones

  [[nodiscard]] std::string scoped(const std::string& name) const {
    return module + "::msg::" + name;
  }
};

/// Errors name the file: kParse for what IdlSchema does not support, for a struct that is not
/// @final (ROS 2 readers need it) or not in `module NAME { module msg {`, and for an enumeration
/// whose values are not different numbers up to 255.
[[nodiscard]] Result<IdlFile> read_idl_file(const std::filesystem::path& path);

}  // namespace furrow::msgs
