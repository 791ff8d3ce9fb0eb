#include "crc32.hpp"

#include <libdeflate.h>

namespace furrow::mcap {
namespace {

/// a * b modulo the polynomial, both reflected (bit 31 is x^0).
std::uint32_t multiply(std::uint32_t a, std::uint32_t b) {
  constexpr std::uint32_t kPolynomial = 0xEDB88320U;
  std::uint32_t product = 0;
  for (std::uint32_t bit = 0x80000000U; bit != 0; bit >>= 1U) {
    if ((a & bit) != 0) {
      product ^= b;
    }
    b = (b >> 1U) ^ ((b & 1U) != 0 ? kPolynomial : 0U);
  }
  return product;
}

}  // namespace

std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before) {
  // Without a buffer libdeflate gives the initial value, whatever was before.
  if (bytes.empty()) return before;
  return libdeflate_crc32(before, bytes.data(), bytes.size());
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
