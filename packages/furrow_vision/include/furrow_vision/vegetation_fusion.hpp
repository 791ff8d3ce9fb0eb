#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "furrow_core/parameters.hpp"
#include "furrow_vision/vegetation_index.hpp"

namespace furrow::vision {

/// What visit() declares says each.
struct VegetationFusionParameters {
  std::string source = "both";  ///< network, index, both
  double plant_threshold = 0.5;
  double network_weight = 1.0;
  double network_logit_max = 4.0;
  double agreement_exponent = 100.0;
  double index_scale = 4.0;
  double trusted_threshold_factor = 0.85;
  VegetationParameters index;
  void visit(ParameterVisitor& v);
};

/// A vegetation mask (CV_8U, 255 plant) of the image's size. It combines a network's coarse logit
/// of "plant" (CV_32F, any size, the same view) and the vegetation index. The index is fine at the
/// edges, and holds for plants and light that the network was not trained on. With "both" a pixel
/// is vegetation when this sum is positive:
///
///     w * clamp(logit, +-network_logit_max) - logit(plant_threshold)
///       + clamp((index - t) / index_scale, +-2 network_logit_max)
///
/// The weight w is network_weight times the trust r^agreement_exponent. Of the pixels that are four
/// index units above the threshold, r is the share in which the network sees plants. A network that
/// misses many of them is probably outside of its training. The factor of Otsu's threshold t goes
/// with the trust from threshold_factor to trusted_threshold_factor. Where the index finds only
/// soil, the network decides alone.
[[nodiscard]] cv::Mat fuse_vegetation(const cv::Mat& plant_logit, const Vegetation& vegetation,
                                      const VegetationFusionParameters& parameters);

}  // namespace furrow::vision
