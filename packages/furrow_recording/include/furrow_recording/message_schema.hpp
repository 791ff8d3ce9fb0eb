#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::recording {

enum class FieldKind : std::uint8_t {
  kBool,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
  kString,
  kWstring,
  kTime,      ///< of ROS 1: seconds and nanoseconds, both uint32
  kDuration,  ///< of ROS 1: seconds and nanoseconds, both int32
  kStruct,
};

/// Bytes of a value; 0 for strings and structs.
[[nodiscard]] std::size_t size_of(FieldKind kind);

struct MessageField {
  std::string name;
  FieldKind kind = FieldKind::kStruct;
  std::string struct_name;     ///< of kStruct: "pkg/Type"
  bool sequence = false;       ///< any number of values
  std::size_t array_size = 0;  ///< a fixed number of values; 0: no array
};

struct MessageStruct {
  std::vector<MessageField> fields;
  std::vector<std::string> constants;  ///< "uint8 FIX=1", as the text defines them
};

enum class RosVersion : std::uint8_t { kRos1, kRos2 };

/// The layout of a message type and of all types in it, by "pkg/Type".
struct MessageSchema {
  std::string root;
  std::map<std::string, MessageStruct> structs;

  [[nodiscard]] const MessageStruct& root_struct() const { return structs.at(root); }
};

/// Parses a message definition: the root's fields, then each further type behind a line of "=" and
/// one of "MSG: pkg/Type". `root` is "pkg/Type" or "pkg/msg/Type". kParse with the line for text
/// that is not a definition, a type that is not defined, and a type that contains itself.
[[nodiscard]] Result<MessageSchema> parse_message_definition(std::string_view text,
                                                             std::string_view root,
                                                             RosVersion version);

/// Parses the text of a file's schema, "ros2msg" or "omgidl". kParse also for other encodings.
[[nodiscard]] Result<MessageSchema> parse_schema_text(std::string_view encoding,
                                                      std::string_view text,
                                                      std::string_view type_name);

/// "pkg/Type" of "pkg/msg/Type" and "pkg::msg::Type".
[[nodiscard]] std::string short_type_name(std::string_view name);

}  // namespace furrow::recording
