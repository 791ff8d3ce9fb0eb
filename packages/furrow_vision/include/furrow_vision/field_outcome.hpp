#pragma once

#include <cstdint>
#include <vector>

#include "furrow_vision/annotated_image.hpp"
#include "furrow_vision/detector.hpp"

namespace furrow::vision {

/// When a detection is sprayed, and what counts as found.
struct SprayRule {
  double weed_probability_min = 0.5;  ///< detections from here on are sprayed at their stem
  double footprint_radius_mm = 25.0;  ///< of a spray, around the stem (paper: 2.5 cm)
  double found_within_mm = 15.0;      ///< a weed is found when a sprayed stem is this near
};

/// What spraying the detections of an image would do to the plants of the ground truth.
struct FieldOutcome {
  std::int64_t crops = 0;
  std::int64_t crops_sprayed = 0;  ///< a sprayed stem in its mask, or a footprint on its stem
  std::int64_t weeds = 0;          ///< whole ones with a known stem or middle
  std::int64_t weeds_found = 0;
  std::int64_t detections_on_nothing = 0;  ///< crop or weed, on no plant and no ignored region
  double area_m2 = 0.0;                    ///< without ignored regions
  std::vector<double> stem_error_mm;       ///< of found weeds whose stem the data set names

  FieldOutcome& operator+=(const FieldOutcome& other);
  [[nodiscard]] double crops_sprayed_pct() const;  ///< NaN without a crop
  [[nodiscard]] double weeds_found_pct() const;    ///< NaN without a weed
  [[nodiscard]] double false_per_m2() const;       ///< NaN without an area
};

/// Weeds cut off by the border (AnnotatedInstance::truncated, or a box at the image's border) do
/// not count; a weed without a stem counts at the middle of its mask. Crops count always. Stems
/// within an ignored region are no hit and no false detection. @pre mm_per_px > 0.
[[nodiscard]] FieldOutcome field_outcome(const AnnotatedImage& truth,
                                         const std::vector<Instance>& detections, double mm_per_px,
                                         const SprayRule& rule = {});

/// Regions of an image that count neither as soil nor as a plant: ignore boxes, and crowd regions
/// with a margin of 2 px, less what an annotated plant covers. CV_8U, 255 ignored.
[[nodiscard]] cv::Mat ignored_region(const AnnotatedImage& truth);

}  // namespace furrow::vision
