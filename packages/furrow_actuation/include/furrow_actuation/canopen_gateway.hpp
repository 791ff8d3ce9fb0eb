#pragma once

#include <cstdint>
#include <span>

#include "furrow_actuation/bounded_vector.hpp"
#include "furrow_core/result.hpp"

namespace furrow::actuation::cia402 {

/// An entry of a drive's object dictionary; values are 1 to 4 bytes.
struct Object {
  std::uint16_t index = 0;
  std::uint8_t sub_index = 0;
  std::uint8_t bytes = 2;
};

/// Telegrams of the Modbus TCP gateway to CANopen objects: function 43 (2Bh), MEI type 13 (0Dh).
/// The Modbus application protocol reserves them for CiA 309-2; the layout is that of the dryve D1
/// manual. The bytes begin at the unit identifier, after the length of the MBAP header. They are
/// unit, function, MEI type, read/write, reserved, node, index high, index low, sub-index. Three
/// bytes of zero, the byte count, and the data (lowest byte first) follow.
inline constexpr std::uint8_t kFunction = 0x2B;
inline constexpr std::uint8_t kMeiType = 0x0D;
inline constexpr std::size_t kHeaderBytes = 13;
using Telegram = BoundedVector<std::uint8_t, kHeaderBytes + 4>;

[[nodiscard]] Telegram read_request(const Object& object);
[[nodiscard]] Telegram write_request(const Object& object, std::int32_t value);
[[nodiscard]] Telegram read_response(const Object& object, std::int32_t value);
[[nodiscard]] Telegram write_response(const Object& object);
/// Unit, function with its highest bit set, exception code.
[[nodiscard]] Telegram exception_response(std::uint8_t code);

struct Request {
  bool write = false;
  Object object;
  std::int32_t value = 0;  ///< sign-extended; writes only
};
/// kParse: not such a telegram.
[[nodiscard]] Result<Request> parse_request(std::span<const std::uint8_t> telegram);

/// The value that answers `read_request(object)`, sign-extended; 0 for an answer to a write.
/// kParse: malformed, or an answer to something else; kUnavailable: an exception of the drive.
[[nodiscard]] Result<std::int32_t> parse_response(std::span<const std::uint8_t> telegram,
                                                  const Object& object, bool write);

}  // namespace furrow::actuation::cia402
