#pragma once

#include <array>
#include <opencv2/core.hpp>
#include <vector>

#include "furrow_vision/model_file.hpp"

namespace furrow::vision {

/// A box by its corners in continuous pixels of a network's input.
struct RegionBox {
  float u0 = 0.0f, v0 = 0.0f, u1 = 0.0f, v1 = 0.0f;
  [[nodiscard]] float width() const { return u1 - u0; }
  [[nodiscard]] float height() const { return v1 - v0; }
};

/// Intersection over union of areas; 0 where both are empty.
[[nodiscard]] double region_iou(const RegionBox& a, const RegionBox& b);

/// One anchor for each aspect ratio r, centred on 0, of the size's area. Its height is size sqrt(r)
/// and its width size / sqrt(r), half of each rounded to even (Ren et al. 2015; torchvision).
[[nodiscard]] std::vector<RegionBox> base_anchors(double size_px,
                                                  const std::vector<double>& aspect_ratios);

/// Applies (du, dv, dw, dh) to a box: the centre moves by shares of its size, the size changes by
/// exponentials; each is divided by its weight first (Girshick et al. 2014). Growth is limited to
/// 1000 / 16.
[[nodiscard]] RegionBox decode_box(const RegionBox& anchor, const std::array<float, 4>& deltas,
                                   const std::array<float, 4>& weights);

[[nodiscard]] RegionBox clip_box(const RegionBox& box, cv::Size image);

/// Greedy non-maximum suppression: indices of what is kept, by falling score, at most `most`. A box
/// goes when its IoU with a kept one is above `iou_max`. @pre sizes agree.
[[nodiscard]] std::vector<int> suppress_overlaps(const std::vector<RegionBox>& boxes,
                                                 const std::vector<float>& scores, double iou_max,
                                                 std::size_t most);

struct ProposalLimits {
  std::size_t before_suppression = 500;  ///< of each level
  std::size_t after_suppression = 200;   ///< of all levels
  double iou_max = 0.7;
};

/// The most probable boxes of a pyramid's levels. Level i has objectness 1 x A x H x W (logits) and
/// deltas 1 x 4A x H x W, both CV_32F, A the number of aspect ratios. Its anchors are
/// anchors.strides_px[i] apart, from 0 on. kInvalidArgument: maps that do not fit the layout.
[[nodiscard]] Result<std::vector<RegionBox>> propose_regions(const std::vector<cv::Mat>& objectness,
                                                             const std::vector<cv::Mat>& deltas,
                                                             const AnchorLayout& anchors,
                                                             cv::Size input,
                                                             const ProposalLimits& limits);

/// The level of a feature pyramid from which a box is cut (Lin et al. 2017): floor(4 +
/// log2(sqrt(area) / 224)) for strides 4, 8, 16, ..., counted from 0 and held within the levels.
[[nodiscard]] int pyramid_level(const RegionBox& box, int levels);

/// RoIAlign (He et al. 2017) with 2 x 2 samples a bin and no half-pixel shift, as torchvision's
/// default: `features` is 1 x C x H x W, `out` takes C x size x size values.
void align_region(const cv::Mat& features, const RegionBox& box, double stride_px, int size,
                  float* out);

/// Value of a square map of logits, stretched over a box, at each pixel of `pixels`, whose centres
/// are at + 0.5. Bilinear between the centres of the map's cells, the value of the rim outside.
/// CV_32F of the size of `pixels`.
[[nodiscard]] cv::Mat stretch_mask(const cv::Mat& logits, const RegionBox& box,
                                   const cv::Rect& pixels);

}  // namespace furrow::vision
