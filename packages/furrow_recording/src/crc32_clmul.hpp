#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace furrow::mcap {

inline constexpr std::size_t kFoldedBytes = 16;
inline constexpr std::size_t kFoldStepBytes = 64;

/// True where the processor multiplies without carry (PCLMULQDQ).
[[nodiscard]] bool has_clmul();

/// Sixteen bytes that, taken from a register of zero, leave the CRC-32 register that `blocks` leave
/// behind `crc`, the register before; by folding (Gopal, Ozturk et al. 2009, "Fast CRC Computation
/// for Generic Polynomials Using PCLMULQDQ").
/// @pre has_clmul(), and `blocks` is a multiple of kFoldStepBytes, at least one.
[[nodiscard]] std::array<std::byte, kFoldedBytes> fold_crc32(std::span<const std::byte> blocks,
                                                             std::uint32_t crc);

}  // namespace furrow::mcap
