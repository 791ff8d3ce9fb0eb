#pragma once

#include <cstdint>
#include <string_view>

namespace furrow {

/// FNV-1a with 64 bits (Fowler, Noll and Vo). The same on every machine and standard library,
/// unlike std::hash. Not collision-resistant: do not use it for untrusted data.
[[nodiscard]] constexpr std::uint64_t fnv1a_64(std::string_view text) {
  std::uint64_t value = 0xCBF29CE484222325ull;
  for (const char c : text) {
    value ^= static_cast<unsigned char>(c);
    value *= 0x100000001B3ull;
  }
  return value;
}

}  // namespace furrow
