#pragma once

#include <cstdint>

namespace furrow::recording {

inline constexpr double kBytesPerMb = 1e6;
inline constexpr std::int64_t kNsPerS = 1'000'000'000;

}  // namespace furrow::recording
