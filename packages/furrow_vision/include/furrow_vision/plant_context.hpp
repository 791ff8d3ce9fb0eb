#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_vision/detector.hpp"
#include "furrow_vision/vegetation_index.hpp"

namespace furrow::vision {

/// What visit() declares says each.
struct PlantContextParameters {
  std::string class_evidence = "auto";  ///< learned, context, auto
  double familiar_from = 0.6;
  double familiar_to = 0.68;
  double look_weight = 0.5;
  double look_middle = -4.0;
  double yellowness_weight = 50.0;
  double yellowness_middle = 0.085;
  double yellowness_evidence_max = 3.0;
  double row_evidence_max = 1.0;
  double row_sd_mm = 50.0;
  double crop_reach_mm = 15.0;
  double crop_reach_area_mm2 = 600.0;
  double greenness_min = 0.04;
  double rare_share = 0.01;
  double rare_greenness_min = 0.075;
  double rare_stem_score_min = 0.25;
  void visit(ParameterVisitor& v);
};

/// Chromatic coordinates of a mean colour, relative to those of the soil in the same image, so that
/// light and white balance cancel to first order.
struct RelativeColour {
  double yellowness = 0.0;  ///< (G - B) / (R + G + B), plant less soil
  double greenness = 0.0;   ///< (G - R) / (R + G + B), plant less soil
};

/// What was done to the plants of one image.
struct ContextReport {
  /// 1: the network's class scores are taken as they are; 0: the context decides with them.
  double familiarity = 1.0;
  /// Mean of Instance::stem_score, over the leaf area. Low where plants look unlike training.
  double stem_certainty = 1.0;
  std::int64_t merged_into_crops = 0;
  std::int64_t dropped_as_not_green = 0;
};

/// Mean colours of the plants, against the soil that lies 3 px and more from vegetation and is
/// neither black nor blown out, or any soil where nearly all is. Empty where the image shows no
/// soil.
/// @pre vegetation is CV_8U of bgr's size.
[[nodiscard]] std::vector<RelativeColour> relative_colours(const cv::Mat& bgr,
                                                           const cv::Mat& vegetation,
                                                           const std::vector<Instance>& plants);

/// Decides the class by the whole plant and its surroundings in images whose plants look unlike
/// those that the network was trained on.
///
/// - Plants that are not greener than the soil by `greenness_min` are dropped (stones, straw,
/// moss).
///   Where vegetation is rare, most of what looks like it is none: a plant whose stem is not seen
///   must there be greener by `rare_greenness_min`.
/// - The familiarity of the image follows from the mean certainty of its stems: the network hardly
///   finds the stems of plants that it does not know. In a familiar image nothing else changes.
/// - The log-odds of a crop become look_weight x (learned log-odds - look_middle) + yellowness
///   evidence, where the crop of most fields is yellower than its weeds. In false colour the
///   yellowness says nothing and is left out.
/// - Plants on the row that most crop plants share gain log-odds, those beside it lose them; see
///   row_evidence.hpp.
/// - A weed whose stem stands within `crop_reach_mm` of the leaves of a crop is taken for a part of
///   that crop: its mask goes to the crop. What is unsure is not sprayed.
/// Merged plants are measured anew.
ContextReport apply_plant_context(const RgbdView& view, const cv::Mat& vegetation,
                                  ColourKind colour, const std::vector<SubClass>& classes,
                                  const PlantContextParameters& parameters,
                                  std::vector<Instance>& plants);

}  // namespace furrow::vision
