#pragma once

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>

#include "furrow_core/parameters.hpp"
#include "furrow_core/random.hpp"
#include "furrow_vision/annotated_image.hpp"

namespace furrow::vision {

/// The transforms of BonnBot-I Plus (Ahmadi et al. 2024) (luminance, colour jitter, 3x3 Gaussian
/// blur, illumination box), each applied with its own probability, and the usual ones of geometry.
struct AugmentationParameters {
  double probability = 0.5;       ///< of each photometric transform, on its own
  double luminance_range = 15.0;  ///< added to L of CIELAB (0..100), +- (our reading of "L")
  double colour_jitter = 0.05;    ///< factor of each colour channel, 1 +-
  double box_gain_min = 5.0;      ///< added to L (0..100) inside the illumination box
  double box_gain_max = 30.0;
  double box_rotation_max_rad = 0.17453292519943295;  ///< 10 degrees
  std::int64_t box_edge_kernel_px = 3;                ///< side of the Gaussian kernel, odd
  double flip_probability = 0.5;                      ///< of each axis
  double scale_min = 1.0;
  double scale_max = 1.0;
  double rotation_max_rad = 0.0;
  void visit(ParameterVisitor& v);
};

/// A rectangle in pixels: centre, size, angle from the image's u axis towards v.
struct IlluminationBox {
  cv::RotatedRect box;
  double gain = 0.0;  ///< added to L (0..100)
  int edge_kernel_px = 3;
};

/// What one draw decided; applying it twice gives the same bytes.
struct AugmentationDraw {
  std::optional<double> luminance;
  std::optional<std::array<double, 3>> channel_gains;  ///< blue, green, red
  bool blur = false;
  std::optional<IlluminationBox> box;
  bool flip_horizontal = false;
  bool flip_vertical = false;
  double scale = 1.0;
  double rotation_rad = 0.0;
};

class Augmenter {
 public:
  /// Throws ConfigError when parameters are out of range.
  explicit Augmenter(const AugmentationParameters& parameters);
  [[nodiscard]] AugmentationDraw draw(cv::Size image_size, Random& random) const;

 private:
  AugmentationParameters parameters_;
};

/// Each on CV_8UC3, in place. The order in apply_augmentation is the order here.
void shift_luminance(cv::Mat& bgr, double delta);
void scale_channels(cv::Mat& bgr, const std::array<double, 3>& gains);
void blur_3x3(cv::Mat& bgr);
void brighten_box(cv::Mat& bgr, const IlluminationBox& box);

/// Geometry first (image, masks, stems, vegetation; instances that leave the image are dropped,
/// and what the image then lacks takes its mean colour), then the photometric transforms. Geometry
/// clears pose, velocity and depth_path, which no longer fit. The pixels are changed on the spot:
/// give a clone where the original is still needed. @pre image.bgr is loaded.
void apply_augmentation(const AugmentationDraw& draw, AnnotatedImage& image);

}  // namespace furrow::vision
