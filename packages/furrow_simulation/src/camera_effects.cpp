#include "furrow_simulation/camera_effects.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_core/parallel.hpp"
#include "furrow_core/random.hpp"

namespace furrow::simulation {
namespace {

constexpr int kNoiseSize = 1 << 17;
constexpr double kNoiseDeviation = 32.0;  // of the stored samples
constexpr int kMaxRadius = 12;
constexpr int kHoleCell_px = 5;

// Weights of an odd number of taps that sum to 256: a Gaussian, run along a box.
std::vector<std::int16_t> kernel(double sigma_px, double box_px) {
  std::vector<double> weights(2 * kMaxRadius + 1);
  constexpr int kSamples = 32;
  for (int i = -kMaxRadius; i <= kMaxRadius; ++i) {
    for (int s = 0; s < kSamples; ++s) {
      // Over the pixel's width and the box.
      const double within = (s + 0.5) / kSamples - 0.5;
      if (sigma_px < 0.05) {
        const double distance = std::abs(i + within * 0.999);
        weights[i + kMaxRadius] += distance <= 0.5 * box_px || (i == 0 && box_px < 1.0) ? 1.0 : 0.0;
      } else {
        const double d = i + within * box_px;
        weights[i + kMaxRadius] += std::exp(-0.5 * d * d / (sigma_px * sigma_px));
      }
    }
  }
  double sum = 0.0;
  for (const double w : weights) sum += w;
  int radius = kMaxRadius;
  while (radius > 0 && weights[kMaxRadius + radius] / sum < 0.004) --radius;
  std::vector<std::int16_t> taps;
  int total = 0;
  for (int i = -radius; i <= radius; ++i) {
    taps.push_back(static_cast<std::int16_t>(std::lround(256.0 * weights[i + kMaxRadius] / sum)));
    total += taps.back();
  }
  taps[static_cast<std::size_t>(radius)] =
      static_cast<std::int16_t>(taps[static_cast<std::size_t>(radius)] + 256 - total);
  return taps;
}

std::uint32_t mix(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  std::uint32_t h =
      a * 0x9E3779B1u ^ (b + 0x7F4A7C15u) * 0x85EBCA77u ^ (c + 0x165667B1u) * 0xC2B2AE3Du;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 12;
  h *= 0x297A2D39u;
  return h ^ (h >> 15);
}

// Blurs one row of a picture, vertically and then horizontally. The result is in 256ths in `sum`.
// `between` keeps the row between the passes, which repeats its first and last pixel at its ends.
void blur_row(const cv::Mat& source, const std::vector<std::int16_t>& vertical,
              const std::vector<std::int16_t>& horizontal, int v,
              std::vector<std::uint8_t>& between, std::vector<std::uint16_t>& sum) {
  const int count = 3 * source.cols;
  const int radius_v = static_cast<int>(vertical.size() / 2);
  const int radius_h = static_cast<int>(horizontal.size() / 2);
  std::fill(sum.begin(), sum.end(), std::uint16_t{128});
  for (int k = -radius_v; k <= radius_v; ++k) {
    const auto* row = source.ptr<std::uint8_t>(std::clamp(v + k, 0, source.rows - 1));
    const auto weight = static_cast<std::uint16_t>(vertical[k + radius_v]);
    std::uint16_t* out = sum.data();
    for (int i = 0; i < count; ++i) out[i] = static_cast<std::uint16_t>(out[i] + weight * row[i]);
  }
  std::uint8_t* middle = between.data() + 3 * static_cast<std::ptrdiff_t>(radius_h);
  for (int i = 0; i < count; ++i) middle[i] = static_cast<std::uint8_t>(sum[i] >> 8);
  for (int i = 0; i < 3 * radius_h; ++i) {
    between[i] = middle[i % 3];
    middle[count + i] = middle[count - 3 + i % 3];
  }
  std::fill(sum.begin(), sum.end(), std::uint16_t{128});
  for (int k = 0; k <= 2 * radius_h; ++k) {
    const std::uint8_t* row = between.data() + 3 * static_cast<std::ptrdiff_t>(k);
    const auto weight = static_cast<std::uint16_t>(horizontal[k]);
    std::uint16_t* out = sum.data();
    for (int i = 0; i < count; ++i) out[i] = static_cast<std::uint16_t>(out[i] + weight * row[i]);
  }
}

// Applies vignetting and noise to a blurred row. Gains are in 256ths; noise grows with brightness.
void write_row(const std::vector<std::uint16_t>& sum, const std::vector<std::uint16_t>& fall,
               std::uint16_t row_gain, const std::int8_t* noise, double image_noise,
               std::uint8_t* out) {
  const auto amplitude =
      static_cast<std::int16_t>(std::lround(std::clamp(image_noise, 0.0, 7.0) * 32.0));
  const auto amplitude_dark = static_cast<std::int16_t>(amplitude * 2 / 3);
  const auto amplitude_slope = static_cast<std::int16_t>(amplitude * 2 / 3);  // per 256
  const int count = static_cast<int>(sum.size());
  for (int i = 0; i < count; ++i) {
    const auto value = static_cast<std::uint16_t>(sum[i] >> 8);
    const auto dimmed = static_cast<std::int16_t>(
        static_cast<std::uint16_t>(value * static_cast<std::uint16_t>(row_gain - fall[i])) >> 8);
    const auto gain = static_cast<std::int16_t>(
        amplitude_dark + (static_cast<std::int16_t>(dimmed >> 1) * amplitude_slope >> 7));
    const auto noisy = static_cast<std::int16_t>(
        dimmed + (static_cast<std::int16_t>(noise[i] * std::min<std::int16_t>(gain, 255)) >> 10));
    out[i] = static_cast<std::uint8_t>(
        std::clamp<std::int16_t>(noisy, std::int16_t{0}, std::int16_t{255}));
  }
}

}  // namespace

CameraEffectParameters CameraEffectParameters::none() {
  return {.lens_blur_px = 0.0,
          .motion_blur_px = 0.0,
          .vignetting = 0.0,
          .image_noise = 0.0,
          .depth_noise_m = 0.0,
          .depth_hole_share = 0.0,
          .depth_edge_step_m = 0.0};
}

void CameraEffectParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "lens_blur_px",
           .unit = "px",
           .description = "standard deviation of the lens's point spread",
           .min = 0.0,
           .max = 4.0},
          lens_blur_px);
  v.visit({.name = "motion_blur_px",
           .unit = "px",
           .description = "way of the picture during the exposure, along the travel",
           .min = 0.0,
           .max = 12.0},
          motion_blur_px);
  v.visit({.name = "vignetting",
           .description = "loss of brightness in the corners",
           .min = 0.0,
           .max = 0.9},
          vignetting);
  v.visit({.name = "image_noise",
           .description = "standard deviation at middle grey, of 255",
           .min = 0.0,
           .max = 7.0},
          image_noise);
  v.visit({.name = "depth_noise_m",
           .unit = "m",
           .description = "standard deviation of the depth at 1 m; grows with its square",
           .min = 0.0,
           .max = 0.1},
          depth_noise_m);
  v.visit({.name = "depth_hole_share",
           .description = "share of the depth image that is missing, in small blotches",
           .min = 0.0,
           .max = 0.9},
          depth_hole_share);
  v.visit({.name = "depth_edge_step_m",
           .unit = "m",
           .description = "half of the depths at steps higher than this are missing; 0: none",
           .min = 0.0,
           .max = 1.0},
          depth_edge_step_m);
}

CameraEffects::CameraEffects(const CameraEffectParameters& parameters, std::uint64_t seed)
    : parameters_(parameters),
      seed_(seed),
      noise_(kNoiseSize),
      lens_kernel_(kernel(parameters.lens_blur_px, 0.0)),
      motion_kernel_(kernel(parameters.lens_blur_px, parameters.motion_blur_px)) {
  Random random(seed, "sensor noise");
  for (auto& sample : noise_) {
    sample = static_cast<std::int8_t>(
        std::clamp(std::lround(random.normal(0.0, kNoiseDeviation)), -127l, 127l));
  }
}

void CameraEffects::apply(cv::Mat& bgr, cv::Mat& depth_m, std::uint64_t frame_index,
                          bool motion_along_columns, int threads) const {
  const bool blurs = lens_kernel_.size() > 1 || motion_kernel_.size() > 1;
  if (blurs || parameters_.vignetting > 0.0 || parameters_.image_noise > 0.0) {
    cv::Mat target(bgr.size(), CV_8UC3);
    parallel_bands(bgr.rows, threads, [&](int first, int last) {
      filter_rows(bgr, target, frame_index, motion_along_columns, first, last);
    });
    bgr = target;
  }
  if (parameters_.depth_noise_m > 0.0 || parameters_.depth_hole_share > 0.0 ||
      parameters_.depth_edge_step_m > 0.0) {
    cv::Mat target(depth_m.size(), CV_32FC1);
    parallel_bands(depth_m.rows, threads, [&](int first, int last) {
      degrade_depth(depth_m, target, frame_index, first, last);
    });
    depth_m = target;
  }
}

void CameraEffects::filter_rows(const cv::Mat& source, cv::Mat& target, std::uint64_t frame_index,
                                bool motion_along_columns, int first, int last) const {
  const int count = 3 * source.cols;
  const auto& vertical = motion_along_columns ? motion_kernel_ : lens_kernel_;
  const auto& horizontal = motion_along_columns ? lens_kernel_ : motion_kernel_;
  const int radius_h = static_cast<int>(horizontal.size() / 2);
  std::vector<std::uint8_t> between(static_cast<std::size_t>(count + 6 * radius_h));
  std::vector<std::uint16_t> sum(static_cast<std::size_t>(count));
  std::vector<std::uint16_t> fall(static_cast<std::size_t>(count));
  const double half_x = 0.5 * source.cols;
  const double half_y = 0.5 * source.rows;
  const double scale = 256.0 * parameters_.vignetting / (half_x * half_x + half_y * half_y);
  for (int i = 0; i < count; ++i) {
    const int column = i / 3;
    const double dx = column + 0.5 - half_x;
    fall[i] = static_cast<std::uint16_t>(scale * dx * dx);
  }
  for (int v = first; v < last; ++v) {
    blur_row(source, vertical, horizontal, v, between, sum);
    const double dy = v + 0.5 - half_y;
    const auto row_gain = static_cast<std::uint16_t>(256.0 - scale * dy * dy);
    const std::uint32_t place =
        mix(static_cast<std::uint32_t>(seed_), static_cast<std::uint32_t>(frame_index), v);
    const std::int8_t* noise =
        noise_.data() + place % static_cast<std::uint32_t>(kNoiseSize - count);
    write_row(sum, fall, row_gain, noise, parameters_.image_noise, target.ptr<std::uint8_t>(v));
  }
}

void CameraEffects::degrade_depth(const cv::Mat& source, cv::Mat& target, std::uint64_t frame_index,
                                  int first, int last) const {
  const int width = source.cols;
  const auto key = static_cast<std::uint32_t>(seed_ ^ (frame_index * 0x9E3779B97F4A7C15ull >> 32));
  const auto noise_scale = static_cast<float>(parameters_.depth_noise_m / kNoiseDeviation);
  const auto hole_limit =
      static_cast<std::uint32_t>(std::clamp(parameters_.depth_hole_share, 0.0, 1.0) * 4294967295.0);
  const auto step = static_cast<float>(parameters_.depth_edge_step_m);
  for (int v = first; v < last; ++v) {
    const auto* in = source.ptr<float>(v);
    const auto* up = source.ptr<float>(std::max(v - 1, 0));
    const auto* down = source.ptr<float>(std::min(v + 1, source.rows - 1));
    auto* out = target.ptr<float>(v);
    const std::uint32_t place =
        mix(key, 0xD3ull, v) % static_cast<std::uint32_t>(kNoiseSize - width);
    const std::int8_t* noise = noise_.data() + place;
    for (int u = 0; u < width; ++u) {
      out[u] = in[u] + in[u] * in[u] * noise_scale * static_cast<float>(noise[u]);
    }
    if (step > 0.0f) {
      for (int u = 0; u < width; ++u) {
        const float across = std::abs(in[std::min(u + 1, width - 1)] - in[std::max(u - 1, 0)]);
        if (std::max(across, std::abs(down[u] - up[u])) > step && noise[u] > 0) out[u] = 0.0f;
      }
    }
    if (hole_limit == 0) continue;
    for (int cell = 0; cell * kHoleCell_px < width; ++cell) {
      if (mix(key, cell, v / kHoleCell_px) >= hole_limit) continue;
      const int end = std::min((cell + 1) * kHoleCell_px, width);
      for (int u = cell * kHoleCell_px; u < end; ++u) out[u] = 0.0f;
    }
  }
}

}  // namespace furrow::simulation
