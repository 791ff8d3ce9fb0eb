#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string_view>

#include "furrow_core/result.hpp"

namespace furrow::msgs {

/// A message type for the middleware, which does not know the C++ class. One object per type with
/// static lifetime: compare by address.
struct MessageType {
  std::string_view dds_name;  ///< "sensor_msgs::msg::dds_::Image_"
  std::string_view ros_name;  ///< "sensor_msgs/msg/Image"
  std::string_view idl;       ///< the type and all types that it uses, as OMG IDL

  std::shared_ptr<void> (*create)();
  /// Bytes of the CDR form, with its encapsulation header of four bytes.
  std::size_t (*serialized_size)(const void* message);
  /// Writes the CDR form (XCDR1, little endian) and returns its size. kOutOfRange: the buffer is
  /// too small.
  Result<std::size_t> (*serialize)(const void* message, std::span<std::byte> buffer);
  /// Reads a CDR form of either endianness. kParse: it is truncated or malformed; the message then
  /// has unspecified content.
  Status (*deserialize)(std::span<const std::byte> buffer, void* message);
};

/// The MessageType of a generated class; specialized in message_types.hpp.
template <class Message>
[[nodiscard]] const MessageType& message_type();

}  // namespace furrow::msgs
