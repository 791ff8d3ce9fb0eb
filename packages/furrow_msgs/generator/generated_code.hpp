#pragma once

#include <string>
#include <vector>

#include "idl_file.hpp"

namespace furrow::msgs {

struct GeneratedCode {
  std::string header;
  std::string source;
};

/// message_types.hpp and .cpp: a MessageType for every struct, with its names, its IDL text and its
/// CDR functions.
[[nodiscard]] GeneratedCode message_types_code(const std::vector<IdlFile>& files);

/// enums.hpp and .cpp: an enum class for every enumeration in its ROS 2 form, that is, a struct
/// whose one member is `uint8 value`, after a module NAME_Constants.
[[nodiscard]] GeneratedCode enums_code(const std::vector<IdlFile>& files);

}  // namespace furrow::msgs
