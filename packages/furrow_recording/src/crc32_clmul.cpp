#include "crc32_clmul.hpp"

#if defined(__x86_64__)

#include <immintrin.h>

namespace furrow::mcap {
namespace {

// x^(n+32) and x^(n-32) modulo the polynomial, reflected, for folding over n = 512 and n = 128
// bits.
constexpr long long kOver512High = 0x1c6e41596;
constexpr long long kOver512Low = 0x154442bd4;
constexpr long long kOver128High = 0x0ccaa009e;
constexpr long long kOver128Low = 0x1751997d0;

__attribute__((target("pclmul,sse4.1"))) __m128i fold(__m128i value, __m128i over, __m128i next) {
  const __m128i low = _mm_clmulepi64_si128(value, over, 0x00);
  const __m128i high = _mm_clmulepi64_si128(value, over, 0x11);
  return _mm_xor_si128(_mm_xor_si128(low, high), next);
}

__m128i load(const std::byte* at) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(at));
}

}  // namespace

bool has_clmul() {
  return __builtin_cpu_supports("pclmul") != 0 && __builtin_cpu_supports("sse4.1") != 0;
}

__attribute__((target("pclmul,sse4.1"))) std::array<std::byte, kFoldedBytes> fold_crc32(
    std::span<const std::byte> blocks, std::uint32_t crc) {
  const std::byte* at = blocks.data();
  const std::byte* const end = at + blocks.size();
  __m128i a = _mm_xor_si128(load(at), _mm_cvtsi32_si128(static_cast<int>(crc)));
  __m128i b = load(at + 16);
  __m128i c = load(at + 32);
  __m128i d = load(at + 48);
  const __m128i over_512 = _mm_set_epi64x(kOver512High, kOver512Low);
  for (at += kFoldStepBytes; at != end; at += kFoldStepBytes) {
    a = fold(a, over_512, load(at));
    b = fold(b, over_512, load(at + 16));
    c = fold(c, over_512, load(at + 32));
    d = fold(d, over_512, load(at + 48));
  }
  const __m128i over_128 = _mm_set_epi64x(kOver128High, kOver128Low);
  const __m128i folded = fold(fold(fold(a, over_128, b), over_128, c), over_128, d);
  std::array<std::byte, kFoldedBytes> bytes{};
  _mm_storeu_si128(reinterpret_cast<__m128i*>(bytes.data()), folded);
  return bytes;
}

}  // namespace furrow::mcap

#else

namespace furrow::mcap {

bool has_clmul() {
  return false;
}

std::array<std::byte, kFoldedBytes> fold_crc32(std::span<const std::byte>, std::uint32_t) {
  return {};
}

}  // namespace furrow::mcap

#endif
