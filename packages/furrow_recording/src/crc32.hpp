#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace furrow::mcap {

/// CRC-32 (ISO 3309, reflected polynomial 0xEDB88320) of `bytes` after the bytes whose CRC is
/// `before`; 0: none. By libdeflate.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0);

/// The CRC of A followed by B from those of A and B, without their bytes. libdeflate has none.
[[nodiscard]] std::uint32_t crc32_combine(std::uint32_t a, std::uint32_t b, std::uint64_t b_bytes);

}  // namespace furrow::mcap
