#include "furrow_actuation/canopen_gateway.hpp"

#include <string>

namespace furrow::actuation::cia402 {
namespace {

Telegram header(const Object& object, bool write, std::uint8_t count) {
  Telegram t;
  const std::uint8_t bytes[] = {0,
                                kFunction,
                                kMeiType,
                                static_cast<std::uint8_t>(write ? 1 : 0),
                                0,
                                0,
                                static_cast<std::uint8_t>(object.index >> 8),
                                static_cast<std::uint8_t>(object.index & 0xFF),
                                object.sub_index,
                                0,
                                0,
                                0,
                                count};
  for (const std::uint8_t byte : bytes) t.push_back(byte);
  return t;
}

void append_value(Telegram& t, std::int32_t value, std::uint8_t bytes) {
  const auto bits = static_cast<std::uint32_t>(value);
  for (int i = 0; i < bytes; ++i) {
    t.push_back(static_cast<std::uint8_t>((bits >> (8 * i)) & 0xFF));
  }
}

std::int32_t value_of(std::span<const std::uint8_t> data) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < data.size(); ++i) {
    bits |= static_cast<std::uint32_t>(data[i]) << (8 * i);
  }
  const auto unused = static_cast<int>(32 - 8 * data.size());
  return static_cast<std::int32_t>(bits << unused) >> unused;
}

Error malformed(const char* what) {
  return {ErrorCode::kParse, std::string("CANopen gateway telegram: ") + what};
}

bool has_header(std::span<const std::uint8_t> t) {
  return t.size() >= kHeaderBytes && t[1] == kFunction && t[2] == kMeiType && t[3] <= 1;
}

Object object_of(std::span<const std::uint8_t> t) {
  return {static_cast<std::uint16_t>(t[6] << 8 | t[7]), t[8], t[12]};
}

}  // namespace

Telegram read_request(const Object& object) {
  return header(object, false, object.bytes);
}

Telegram write_request(const Object& object, std::int32_t value) {
  Telegram t = header(object, true, object.bytes);
  append_value(t, value, object.bytes);
  return t;
}

Telegram read_response(const Object& object, std::int32_t value) {
  Telegram t = header(object, false, object.bytes);
  append_value(t, value, object.bytes);
  return t;
}

Telegram write_response(const Object& object) {
  return header(object, true, 0);
}

Telegram exception_response(std::uint8_t code) {
  Telegram t;
  t.push_back(0);
  t.push_back(kFunction | 0x80);
  t.push_back(code);
  return t;
}

Result<Request> parse_request(std::span<const std::uint8_t> telegram) {
  if (!has_header(telegram)) return malformed("no such request");
  Request request{telegram[3] == 1, object_of(telegram), 0};
  if (request.object.bytes < 1 || request.object.bytes > 4) {
    return malformed("the byte count is not 1 to 4");
  }
  const std::size_t data = request.write ? request.object.bytes : 0u;
  if (telegram.size() != kHeaderBytes + data) return malformed("the length does not fit");
  if (request.write) request.value = value_of(telegram.subspan(kHeaderBytes));
  return request;
}

Result<std::int32_t> parse_response(std::span<const std::uint8_t> telegram, const Object& object,
                                    bool write) {
  if (telegram.size() >= 3 && telegram[1] == (kFunction | 0x80)) {
    return Error{ErrorCode::kUnavailable,
                 "the drive refused with Modbus exception " + std::to_string(telegram[2])};
  }
  if (!has_header(telegram)) return malformed("no such response");
  const Object answered = object_of(telegram);
  if ((telegram[3] == 1) != write || answered.index != object.index ||
      answered.sub_index != object.sub_index) {
    return malformed("the response answers another request");
  }
  if (write) return 0;
  if (answered.bytes != object.bytes || telegram.size() != kHeaderBytes + object.bytes) {
    return malformed("the response has another length than the object");
  }
  return value_of(telegram.subspan(kHeaderBytes));
}

}  // namespace furrow::actuation::cia402
