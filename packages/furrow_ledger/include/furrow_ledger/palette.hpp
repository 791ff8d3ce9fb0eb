#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace furrow::ledger {

/// Colours that people with the common colour-vision deficiencies can tell apart, on a light
/// ground, after Okabe and Ito (2008) and darkened where thin lines need it.
namespace palette {
inline constexpr std::string_view kInk = "#1f2a24";
inline constexpr std::string_view kMuted = "#66736b";
inline constexpr std::string_view kFaint = "#dfe4dd";
inline constexpr std::string_view kPaper = "#ffffff";
inline constexpr std::string_view kGround = "#f7f6f1";
inline constexpr std::string_view kCrop = "#2e8b57";
inline constexpr std::string_view kAccurate = "#0072b2";
inline constexpr std::string_view kPartial = "#56b4e9";
inline constexpr std::string_view kMissed = "#d55e00";
inline constexpr std::string_view kMissedVision = "#b3367e";
inline constexpr std::string_view kHit = "#c1121f";
inline constexpr std::array<std::string_view, 8> kSeries = {
    "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#7a6ff0", "#5c5c5c"};
}  // namespace palette

/// The colour of the i-th series or axis; they repeat after eight.
[[nodiscard]] constexpr std::string_view series_color(std::size_t index) {
  return palette::kSeries[index % palette::kSeries.size()];
}

}  // namespace furrow::ledger
