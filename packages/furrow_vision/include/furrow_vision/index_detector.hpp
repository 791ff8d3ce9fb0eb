#pragma once

#include <memory>

#include "furrow_core/parameters.hpp"
#include "furrow_vision/detector.hpp"
#include "furrow_vision/vegetation_index.hpp"

namespace furrow::vision {

struct IndexDetectorParameters {
  VegetationParameters vegetation;
  double min_plant_area_mm2 = 25.0;
  double merge_gap_factor = 0.35;
  double merge_gap_max_mm = 12.0;
  double split_saddle_ratio = 0.62;
  double split_min_area_mm2 = 250.0;
  double row_spacing_m = 0.5;
  double row_half_width_m = 0.04;
  double row_memory = 0.7;
  double crop_area_mm2 = 900.0;
  double prior_crop = 0.3;
  void visit(ParameterVisitor& v);
};

/// The baseline without learning: vegetation index, Otsu's threshold, connected components joined
/// and split into plants, crop or weed by the distance from the crop row and by the size. Classes:
/// "crop", "weed". Keeps the phase of the rows over frames (reset() forgets it); rows run along
/// the image's columns.
class IndexDetector final : public Detector {
 public:
  /// Throws ConfigError when parameters are out of range.
  explicit IndexDetector(const IndexDetectorParameters& parameters);
  ~IndexDetector() override;

  [[nodiscard]] Result<std::vector<Instance>> detect(const RgbdView& view) override;
  [[nodiscard]] const std::vector<SubClass>& classes() const override;
  void reset() override;

  /// Columns of the crop rows as taken in the last frame; empty before the first, or when no row
  /// stood out.
  [[nodiscard]] const std::vector<double>& crop_row_u_px() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::vision
