#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_vision/detector.hpp"
#include "furrow_vision/network_use.hpp"
#include "furrow_vision/vegetation_fusion.hpp"

namespace furrow::vision {

/// What visit() declares says each.
struct MaskRcnnParameters {
  VegetationFusionParameters vegetation;
  double score_min = 0.3;
  double iou_max = 0.3;
  double proposal_iou_max = 0.7;
  std::int64_t proposals_max = 200;
  std::int64_t plants_max = 200;
  double min_plant_area_mm2 = 10.0;
  NetworkUse network;
  void visit(ParameterVisitor& v);
};

/// Mask R-CNN (He et al. 2017) in three networks, with super-class (plant or background) and
/// sub-class scores (Halstead et al. 2021): the score of an instance is 1 - p(background), boxes
/// suppress each other whatever their classes are. Inputs and outputs, n boxes of K classes:
///   backbone  `image` 1x3xHxW, BGR in 0..1, H and W multiples of 32
///             -> `features_i` 1xCxH/s x W/s of strides 4, 8, ... (one a level of anchors, or
///             fewer)
///             -> `objectness_i` 1xAx.., `deltas_i` 1x4Ax.. for each level i of anchors
///   box_head  `regions` nxCx7x7 -> `class_logits` nx(1+K), background first; `box_deltas`
///             nx4 or nx4(1+K), weighted by 10, 10, 5, 5; where the model file says `stems: true`,
///             `stems` nx2, from the region's centre to the stem in sizes of the region
///   mask_head `regions` nxCx14x14 -> `mask_logits` nx1xMxM, nxKxMxM or nx(1+K)xMxM
/// Without `stems` they are the densest places of the masks, moved to the ground by the depth.
/// Keeps no state.
class MaskRcnnDetector final : public Detector {
 public:
  /// Throws ConfigError as OneStageDetector does.
  MaskRcnnDetector(const MaskRcnnParameters& parameters, const std::filesystem::path& model_file);
  ~MaskRcnnDetector() override;

  [[nodiscard]] Result<std::vector<Instance>> detect(const RgbdView& view) override;
  [[nodiscard]] const std::vector<SubClass>& classes() const override;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace furrow::vision
