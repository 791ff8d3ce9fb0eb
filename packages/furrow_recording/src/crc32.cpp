#include "crc32.hpp"

#include <array>
#include <bit>
#include <cstring>

#include "crc32_clmul.hpp"

namespace furrow::mcap {
namespace {

constexpr std::uint32_t kPolynomial = 0xEDB88320U;
constexpr std::size_t kSlices = 16;
using Tables = std::array<std::array<std::uint32_t, 256>, kSlices>;

constexpr Tables make_tables() {
  Tables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc >> 1U) ^ ((crc & 1U) != 0 ? kPolynomial : 0U);
    }
    tables[0][byte] = crc;
  }
  for (std::size_t slice = 1; slice < kSlices; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t crc = tables[slice - 1][byte];
      tables[slice][byte] = (crc >> 8U) ^ tables[0][crc & 0xFFU];
    }
  }
  return tables;
}

constexpr Tables kTables = make_tables();

std::uint32_t load_le(const std::byte* bytes) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes, sizeof word);
  static_assert(std::endian::native == std::endian::little);
  return word;
}

/// a * b modulo the polynomial, both reflected (bit 31 is x^0).
std::uint32_t multiply(std::uint32_t a, std::uint32_t b) {
  std::uint32_t product = 0;
  for (std::uint32_t bit = 0x80000000U; bit != 0; bit >>= 1U) {
    if ((a & bit) != 0) {
      product ^= b;
    }
    b = (b >> 1U) ^ ((b & 1U) != 0 ? kPolynomial : 0U);
  }
  return product;
}

/// The register behind `bytes`, from the one before.
std::uint32_t by_tables(std::span<const std::byte> bytes, std::uint32_t crc) {
  const std::byte* at = bytes.data();
  std::size_t left = bytes.size();
  const auto four = [](std::uint32_t word, std::size_t slice) {
    return kTables[slice + 3][word & 0xFFU] ^ kTables[slice + 2][(word >> 8U) & 0xFFU] ^
           kTables[slice + 1][(word >> 16U) & 0xFFU] ^ kTables[slice][word >> 24U];
  };
  for (; left >= kSlices; left -= kSlices, at += kSlices) {
    crc = four(load_le(at) ^ crc, 12) ^ four(load_le(at + 4), 8) ^ four(load_le(at + 8), 4) ^
          four(load_le(at + 12), 0);
  }
  for (; left > 0; --left, ++at) {
    crc = (crc >> 8U) ^ kTables[0][(crc ^ std::to_integer<std::uint32_t>(*at)) & 0xFFU];
  }
  return crc;
}

}  // namespace

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before) {
  static const bool can_fold = has_clmul();
  std::uint32_t crc = ~before;
  if (can_fold && bytes.size() >= kFoldStepBytes) {
    const std::size_t whole = bytes.size() / kFoldStepBytes * kFoldStepBytes;
    crc = by_tables(fold_crc32(bytes.first(whole), crc), 0);
    bytes = bytes.subspan(whole);
  }
  return ~by_tables(bytes, crc);
}

std::uint32_t crc32_combine(std::uint32_t a, std::uint32_t b, std::uint64_t b_bytes) {
  // a times x^(8 b_bytes), by repeated squaring.
  std::uint32_t power = 0x00800000U;   // x^8
  std::uint32_t factor = 0x80000000U;  // x^0
  for (; b_bytes != 0; b_bytes >>= 1U) {
    if ((b_bytes & 1U) != 0) {
      factor = multiply(factor, power);
    }
    power = multiply(power, power);
  }
  return multiply(factor, a) ^ b;
}

}  // namespace furrow::mcap
