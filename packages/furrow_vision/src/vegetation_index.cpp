#include "furrow_vision/vegetation_index.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/imgproc.hpp>

namespace furrow::vision {
namespace {

using Histogram = std::array<std::uint32_t, 256>;

/// The grey level at which the index equals the plain excess green.
constexpr double kMediumSum = 3.0 * 110.0;

/// Otsu's threshold with all values below kIndexZero taken as kIndexZero: redder soils than grey
/// are no class of their own.
int otsu_threshold(const Histogram& histogram) {
  std::array<double, 256> counts{};
  double total = 0.0, moment = 0.0;
  for (int i = 0; i < 256; ++i) counts[std::max(i, kIndexZero)] += histogram[i];
  for (int i = kIndexZero; i < 256; ++i) {
    total += counts[i];
    moment += i * counts[i];
  }
  double below = 0.0, moment_below = 0.0, best = -1.0;
  int threshold = kIndexZero;
  for (int i = kIndexZero; i < 255; ++i) {
    below += counts[i];
    moment_below += i * counts[i];
    if (below == 0.0 || below == total) continue;
    const double difference = (moment - moment_below) / (total - below) - moment_below / below;
    const double between = below * (total - below) * difference * difference;
    if (between > best) {
      best = between;
      threshold = i;
    }
  }
  return threshold;
}

struct Part {
  double count = 0.0;
  double mean = 0.0;
};

Part part_of(const Histogram& histogram, int first, int last) {
  Part part;
  for (int i = first; i <= last; ++i) {
    part.count += histogram[i];
    part.mean += static_cast<double>(i) * histogram[i];
  }
  if (part.count > 0.0) part.mean /= part.count;
  return part;
}

/// The value below which a fraction of the pixels at or below `last` lies, between the levels.
double quantile_below(const Histogram& histogram, int last, double fraction) {
  const double wanted = fraction * part_of(histogram, 0, last).count;
  double sum = 0.0;
  for (int i = 0; i <= last; ++i) {
    if (sum + histogram[i] >= wanted && histogram[i] > 0) {
      return i - 0.5 + (wanted - sum) / histogram[i];
    }
    sum += histogram[i];
  }
  return last;
}

/// Upper end of the soil's spread: its median plus a multiple of its deviation. The deviation comes
/// from the lower side, where no plants are. Pixels below the end count as soil in the next round,
/// which brings a threshold out that fell within the soil.
int soil_end(const Histogram& histogram, int threshold, double deviations) {
  constexpr int kRounds = 5;
  int end = threshold;
  for (int round = 0; round < kRounds; ++round) {
    const double median = quantile_below(histogram, threshold, 0.5);
    const double deviation = median - quantile_below(histogram, threshold, 0.1587);
    end = std::min(254, static_cast<int>(std::lround(median + deviations * deviation)));
    if (end <= threshold) break;
    threshold = end;
  }
  return end;
}

}  // namespace

void VegetationParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "colour",
           .description = "Kind of the images; auto tells false colour by equal blue and red",
           .choices = {"auto", "natural", "false_colour"}},
          colour);
  v.visit({.name = "softening",
           .description =
               "Added to R + G + B in the index: 0 is robust to light, but noisy in the dark",
           .min = 0.0,
           .max = 1e5},
          softening);
  v.visit({.name = "threshold_factor",
           .description = "Share of Otsu's threshold that is used; below 1 keeps pale leaf edges",
           .min = 0.1,
           .max = 2.0},
          threshold_factor);
  v.visit({.name = "soil_deviations",
           .description = "Least threshold, in standard deviations above the soil's median",
           .min = 0.0,
           .max = 20.0},
          soil_deviations);
  v.visit(
      {.name = "soil_deviations_dense",
       .description = "As soil_deviations, where vegetation is not rare: beside many plants the "
                      "tail of the soil's spread counts little, and leaf edges count more",
       .min = 0.0,
       .max = 20.0},
      soil_deviations_dense);
  v.visit({.name = "dense_share",
           .description = "Share of the image from which on vegetation is not rare",
           .min = 0.0,
           .max = 1.0},
          dense_share);
  v.visit({.name = "min_separation",
           .description = "Least difference of the mean index of plants and soil; else soil only",
           .min = 0.0,
           .max = 255.0},
          min_separation);
  v.visit({.name = "min_contrast",
           .description = "Least distance of the plants' mean index from the soil's, over that of "
                          "the threshold; else soil only",
           .min = 1.0,
           .max = 10.0},
          min_contrast);
  v.visit({.name = "median_px",
           .unit = "px",
           .description = "Side of the median filter on the mask: 1 (none), 3 or 5",
           .min = 1.0,
           .max = 5.0},
          median_px);
}

IndexImage vegetation_index(const cv::Mat& bgr, double softening) {
  constexpr int kFractionBits = 14;
  std::array<std::int32_t, 3 * 255 + 1> factors{};
  for (std::size_t sum = 0; sum < factors.size(); ++sum) {
    const double divisor = std::max(1.0, static_cast<double>(sum) + softening);
    factors[sum] = static_cast<std::int32_t>(
        std::lround((kMediumSum + softening) / divisor * (1 << kFractionBits)));
  }
  IndexImage result{cv::Mat(bgr.size(), CV_8U), {}};
  constexpr int kZero = (kIndexZero << kFractionBits) + (1 << (kFractionBits - 1));
  for (int v = 0; v < bgr.rows; ++v) {
    const auto* pixel = bgr.ptr<std::uint8_t>(v);
    auto* out = result.index.ptr<std::uint8_t>(v);
    for (int u = 0; u < bgr.cols; ++u, pixel += 3) {
      const int sum = pixel[0] + pixel[1] + pixel[2];
      const std::int64_t value =
          static_cast<std::int64_t>(3 * pixel[1] - sum) * factors[sum] + kZero;
      const auto index =
          static_cast<std::uint8_t>(std::clamp<std::int64_t>(value >> kFractionBits, 0, 255));
      out[u] = index;
      ++result.histogram[index];
    }
  }
  return result;
}

ColourKind detect_colour_kind(const cv::Mat& bgr) {
  const int step_v = std::max(1, bgr.rows / 64), step_u = std::max(1, bgr.cols / 64);
  int samples = 0, agree = 0;
  double green_off = 0.0;
  for (int v = step_v / 2; v < bgr.rows; v += step_v) {
    const auto* row = bgr.ptr<cv::Vec3b>(v);
    for (int u = step_u / 2; u < bgr.cols; u += step_u) {
      const cv::Vec3b& p = row[u];
      ++samples;
      if (std::abs(p[0] - p[2]) <= 3) ++agree;
      green_off += std::abs(p[1] - (p[0] + p[2]) / 2);
    }
  }
  const bool equal = agree >= 0.97 * samples;
  return equal && green_off >= 2.0 * samples ? ColourKind::kFalseColour : ColourKind::kNatural;
}

int Vegetation::threshold_at(double factor) const {
  return std::max(kIndexZero + static_cast<int>(std::lround(factor * (otsu - kIndexZero))),
                  soil_end);
}

Vegetation segment_vegetation(const cv::Mat& bgr, const VegetationParameters& parameters) {
  Vegetation result;
  if (parameters.colour == "auto") {
    result.colour = detect_colour_kind(bgr);
  } else if (parameters.colour == "false_colour") {
    result.colour = ColourKind::kFalseColour;
  }
  const IndexImage image = vegetation_index(bgr, parameters.softening);
  result.index = image.index;
  result.otsu = otsu_threshold(image.histogram);
  result.soil_end = soil_end(image.histogram, result.otsu, parameters.soil_deviations);
  const double certain =
      part_of(image.histogram, result.threshold_at(parameters.threshold_factor) + 1, 255).count;
  if (certain >= parameters.dense_share * static_cast<double>(image.index.total())) {
    result.soil_end =
        soil_end(image.histogram, result.otsu,
                 std::min(parameters.soil_deviations, parameters.soil_deviations_dense));
  }
  result.threshold = result.threshold_at(parameters.threshold_factor);
  const Part soil = part_of(image.histogram, 0, result.threshold);
  const Part plants = part_of(image.histogram, result.threshold + 1, 255);
  // The tail of the soil's own spread ends close above any threshold; plants go far beyond.
  const double least =
      std::max(parameters.min_separation, parameters.min_contrast * (result.threshold - soil.mean));
  result.found = plants.count > 0.0 && soil.count > 0.0 && plants.mean - soil.mean >= least;
  if (!result.found) {
    result.mask = cv::Mat::zeros(bgr.size(), CV_8U);
    return result;
  }
  cv::threshold(image.index, result.mask, result.threshold, 255, cv::THRESH_BINARY);
  if (parameters.median_px > 1) {
    cv::medianBlur(result.mask, result.mask, static_cast<int>(parameters.median_px) | 1);
  }
  return result;
}

}  // namespace furrow::vision
