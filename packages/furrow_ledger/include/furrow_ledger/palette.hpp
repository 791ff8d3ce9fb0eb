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
inline constexpr std::string_view kCrop = "#58a37b";
inline constexpr std::string_view kTreated = "#93a5ad";  ///< a weed that is dealt with
inline constexpr std::string_view kMissed = "#d55e00";   ///< by planning, machine or run
inline constexpr std::string_view kMissedVision = "#8f2d83";
inline constexpr std::string_view kLeft = "#6f766f";  ///< on purpose
inline constexpr std::string_view kHit = "#c1121f";
inline constexpr std::array<std::string_view, 8> kAxes = {
    "#2f6fde", "#e39a12", "#0f9e98", "#cf5f9e", "#5c5c5c", "#8a6d3b", "#6fb7e9", "#a3b500"};
inline constexpr std::array<std::string_view, 8> kSeries = {
    "#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#7a6ff0", "#5c5c5c"};
}  // namespace palette

/// The colour of the i-th axis; they repeat after eight.
[[nodiscard]] constexpr std::string_view axis_color(std::size_t index) {
  return palette::kAxes[index % palette::kAxes.size()];
}

/// The colour of the i-th series; they repeat after eight.
[[nodiscard]] constexpr std::string_view series_color(std::size_t index) {
  return palette::kSeries[index % palette::kSeries.size()];
}

}  // namespace furrow::ledger
