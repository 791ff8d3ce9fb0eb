#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"

namespace furrow::vision {

enum class ColourKind {
  kNatural,      ///< red, green, blue
  kFalseColour,  ///< green channel: near infrared; blue and red channels: red (as in CWFID)
};

struct VegetationParameters {
  std::string colour = "auto";  ///< auto, natural, false_colour
  /// Least threshold and least distance between the means of the two classes, in units of the
  /// index (0..255): below it the image counts as soil only.
  double min_threshold = 12.0;
  double min_separation = 16.0;
  std::int64_t median_px = 3;
  void visit(ParameterVisitor& v);
};

struct Vegetation {
  cv::Mat mask;  ///< CV_8U, 255 vegetation
  ColourKind colour = ColourKind::kNatural;
  double threshold = 0.0;
  bool found = false;  ///< false: the guards say soil only, and mask is zero
};

/// False colour when blue and red agree on nearly all of a sample of pixels, yet green does not.
[[nodiscard]] ColourKind detect_colour_kind(const cv::Mat& bgr);

/// Excess green of chromatic coordinates, 2g - r - b (Woebbecke et al. 1995), scaled to 0..255
/// with values below zero cut off. CV_8U. @pre bgr is CV_8UC3.
[[nodiscard]] cv::Mat excess_green(const cv::Mat& bgr);

/// Vegetation by the index and Otsu's threshold (Otsu 1979) with guards against images without
/// plants. @pre bgr is CV_8UC3 and not empty.
[[nodiscard]] Vegetation segment_vegetation(const cv::Mat& bgr,
                                            const VegetationParameters& parameters);

}  // namespace furrow::vision
