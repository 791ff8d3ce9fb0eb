#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "furrow_core/parameters.hpp"

namespace furrow::vision {

enum class ColourKind {
  kNatural,      ///< red, green, blue
  kFalseColour,  ///< green channel: near infrared; blue and red channels: red (as in CWFID)
};

struct VegetationParameters {
  std::string colour = "auto";  ///< auto, natural, false_colour
  double softening = 300.0;
  double threshold_factor = 0.8;
  double soil_deviations = 4.0;
  double soil_deviations_dense = 3.0;
  double dense_share = 0.01;
  double min_separation = 20.0;
  double min_contrast = 1.2;
  std::int64_t median_px = 3;
  void visit(ParameterVisitor& v);
};

/// The index of soil without colour; greener is above.
constexpr int kIndexZero = 64;

struct IndexImage {
  cv::Mat index;                             ///< CV_8U
  std::array<std::uint32_t, 256> histogram;  ///< of `index`
};

/// Excess green 2G - R - B (Woebbecke et al. 1995), divided by R + G + B + softening: between the
/// plain one (softening great), which darkness dims, and that of chromatic coordinates (0), which
/// darkness makes noisy. Scaled to agree with the plain one at medium brightness, plus kIndexZero,
/// cut to 0..255. In false colour it is twice the difference of near infrared and red, softly
/// normalised as the NDVI is. @pre bgr is CV_8UC3; softening >= 0.
[[nodiscard]] IndexImage vegetation_index(const cv::Mat& bgr, double softening);

/// False colour when blue and red agree on nearly all of a sample of pixels, yet green does not.
[[nodiscard]] ColourKind detect_colour_kind(const cv::Mat& bgr);

struct Vegetation {
  cv::Mat mask;  ///< CV_8U, 255 vegetation
  cv::Mat index;
  ColourKind colour = ColourKind::kNatural;
  int threshold = 255;  ///< vegetation is above
  int otsu = 255;       ///< Otsu's threshold
  int soil_end = 0;     ///< no threshold may be lower
  bool found = false;   ///< false: soil only; mask is zero

  /// The threshold by another factor of Otsu's (above kIndexZero).
  [[nodiscard]] int threshold_at(double factor) const;
};

/// Vegetation by the index and Otsu's threshold (Otsu 1979), held above the soil's own spread and
/// guarded against images without plants. An image that holds plants only is not told from soil.
/// @pre bgr is CV_8UC3 and not empty.
[[nodiscard]] Vegetation segment_vegetation(const cv::Mat& bgr,
                                            const VegetationParameters& parameters);

}  // namespace furrow::vision
