#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>
#include <fastcdr/exceptions/Exception.h>

#include <string>

#include "furrow_msgs/message_type.hpp"

namespace furrow::msgs {

inline constexpr std::size_t kEncapsulationBytes = 4;

template <class Message>
[[nodiscard]] MessageType make_message_type(std::string_view dds_name, std::string_view ros_name,
                                            std::string_view idl) {
  using eprosima::fastcdr::Cdr;
  using eprosima::fastcdr::FastBuffer;
  MessageType type;
  type.dds_name = dds_name;
  type.ros_name = ros_name;
  type.idl = idl;
  type.create = []() -> std::shared_ptr<void> { return std::make_shared<Message>(); };
  type.serialized_size = [](const void* message) {
    return kEncapsulationBytes +
           Message::getCdrSerializedSize(*static_cast<const Message*>(message));
  };
  type.serialize = [](const void* message, std::span<std::byte> buffer) -> Result<std::size_t> {
    try {
      FastBuffer stream(reinterpret_cast<char*>(buffer.data()), buffer.size());
      Cdr cdr(stream, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
      cdr.serialize_encapsulation();
      static_cast<const Message*>(message)->serialize(cdr);
      return cdr.getSerializedDataLength();
    } catch (const eprosima::fastcdr::exception::Exception& failure) {
      return Error{ErrorCode::kOutOfRange, failure.what()};
    }
  };
  type.deserialize = [](std::span<const std::byte> buffer, void* message) -> Status {
    try {
      // Fast CDR reads through a mutable buffer but does not write when deserializing.
      auto* data = const_cast<char*>(reinterpret_cast<const char*>(buffer.data()));
      FastBuffer stream(data, buffer.size());
      Cdr cdr(stream, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
      cdr.read_encapsulation();
      static_cast<Message*>(message)->deserialize(cdr);
      return {};
    } catch (const std::exception& failure) {
      return Error{ErrorCode::kParse, std::string("malformed CDR: ") + failure.what()};
    }
  };
  return type;
}

}  // namespace furrow::msgs
