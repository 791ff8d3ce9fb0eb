#include "furrow_vision/vegetation_fusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace furrow::vision {

void VegetationFusionParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "vegetation_source",
           .description = "What the mask of plants is made of: the network, the vegetation index, "
                          "or both together",
           .choices = {"network", "index", "both"}},
          source);
  v.visit({.name = "plant_threshold",
           .description = "Probability of a plant from which on a pixel is one",
           .min = 0.01,
           .max = 0.99},
          plant_threshold);
  v.visit({.name = "network_weight",
           .description = "Of the network's log-odds beside the index",
           .min = 0.0,
           .max = 10.0},
          network_weight);
  v.visit({.name = "network_logit_max",
           .description = "The network's log-odds are cut to this, so that the index can overrule",
           .min = 0.1,
           .max = 50.0},
          network_logit_max);
  v.visit({.name = "agreement_exponent",
           .description = "How much less the network weighs in an image where it misses pixels "
                          "that the index is sure of: weight times the share it sees to this power",
           .min = 0.0,
           .max = 100.0},
          agreement_exponent);
  v.visit({.name = "index_scale",
           .description = "Levels of the index above its threshold that are one unit of log-odds",
           .min = 0.5,
           .max = 200.0},
          index_scale);
  v.visit({.name = "trusted_threshold_factor",
           .description = "As threshold_factor, which holds where the network is not trusted: a "
                          "trusted one finds the pale edges of leaves itself",
           .min = 0.1,
           .max = 2.0},
          trusted_threshold_factor);
  index.visit(v);
}

namespace {

/// Share of the pixels above a level of the index in which the network sees plants; 1 where there
/// are none.
double agreement(const cv::Mat& logit, const cv::Mat& index, double level, float bias) {
  const cv::Mat sure = index > level;
  const int all = cv::countNonZero(sure);
  return all == 0 ? 1.0 : static_cast<double>(cv::countNonZero(sure & (logit > bias))) / all;
}

}  // namespace

cv::Mat fuse_vegetation(const cv::Mat& plant_logit, const Vegetation& vegetation,
                        const VegetationFusionParameters& parameters) {
  if (parameters.source == "index") return vegetation.mask.clone();
  const auto bias =
      static_cast<float>(std::log(parameters.plant_threshold / (1.0 - parameters.plant_threshold)));
  const bool index_too = parameters.source == "both" && vegetation.found;
  cv::Mat logit;
  cv::resize(plant_logit, logit, vegetation.index.size(), 0.0, 0.0, cv::INTER_LINEAR);
  double trust = 1.0;
  if (index_too) {
    constexpr double kSure = 4.0;
    const double sure = vegetation.threshold + kSure * parameters.index_scale;
    trust = std::pow(agreement(logit, vegetation.index, sure, bias), parameters.agreement_exponent);
  }
  const double factor =
      std::lerp(parameters.index.threshold_factor, parameters.trusted_threshold_factor, trust);
  const double threshold = vegetation.threshold_at(factor);
  // Of each level of the index, once.
  std::array<float, 256> evidence{};
  const double most = 2.0 * parameters.network_logit_max;
  for (int i = 0; index_too && i < 256; ++i) {
    evidence[i] =
        static_cast<float>(std::clamp((i - threshold - 0.5) / parameters.index_scale, -most, most));
  }
  const auto weight = static_cast<float>(index_too ? parameters.network_weight * trust : 1.0);
  const auto cut = index_too ? static_cast<float>(parameters.network_logit_max)
                             : std::numeric_limits<float>::max();
  cv::Mat mask(vegetation.index.size(), CV_8U);
  for (int v = 0; v < mask.rows; ++v) {
    const float* l = logit.ptr<float>(v);
    const auto* index = vegetation.index.ptr<std::uint8_t>(v);
    auto* out = mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u) {
      const float sum = weight * std::min(std::max(l[u], -cut), cut) + evidence[index[u]];
      out[u] = sum > bias ? 255 : 0;
    }
  }
  // Where pixels are not much finer than the network's cells, a median would take thin leaves away,
  // and the network keeps specks out.
  constexpr int kCoarseCell_px = 8;
  const bool fine = vegetation.index.cols > kCoarseCell_px * plant_logit.cols;
  if (index_too && fine && parameters.index.median_px > 1) {
    cv::medianBlur(mask, mask, static_cast<int>(parameters.index.median_px) | 1);
  }
  return mask;
}

}  // namespace furrow::vision
