#pragma once

#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_vision/detector.hpp"
#include "furrow_vision/vegetation_index.hpp"

namespace furrow::vision {

/// What visit() declares says each.
struct IndexDetectorParameters {
  VegetationParameters vegetation;
  double grouping_resolution_mm = 2.3;
  double min_plant_area_mm2 = 20.0;
  double merge_gap_min_mm = 5.0;
  double merge_gap_factor = 0.35;
  double merge_gap_max_mm = 10.0;
  double closing_factor = 0.14;
  double split_saddle_ratio = 0.55;
  double split_min_area_mm2 = 600.0;
  double stem_kernel_factor = 2.0;
  double row_spacing_m = 0.5;
  double row_sd_m = 0.02;
  double row_memory = 0.7;
  double row_contrast_min = 1.6;
  double crop_share = 0.35;
  double crop_area_mm2 = 6000.0;
  double crop_area_log_sd = 0.8;
  double weed_area_mm2 = 800.0;
  double weed_area_log_sd = 1.2;
  void visit(ParameterVisitor& v);

 private:
  void visit_grouping(ParameterVisitor& v);
  void visit_rows(ParameterVisitor& v);
  void visit_classes(ParameterVisitor& v);
};

/// The baseline without learning. Vegetation is found by an index and Otsu's threshold.
///
/// - Plants: pieces of leaf are joined where the gap between them is small for their size, and
/// split
///   where the distance transform has a narrow saddle. At most kMaxPlants, the largest.
/// - Classes "crop" and "weed": by Bayes' rule from the distance to the crop row and the leaf area.
/// - Rows run along the image's columns, row_spacing_m apart. Their phase is found in the image and
///   smoothed over frames (state; reset() forgets it).
/// - The score is area / (area + min_plant_area_mm2), low for specks.
class IndexDetector final : public Detector {
 public:
  static constexpr int kMaxPlants = 2000;

  /// Throws ConfigError when parameters are out of range.
  explicit IndexDetector(const IndexDetectorParameters& parameters);
  ~IndexDetector() override;

  [[nodiscard]] Result<std::vector<Instance>> detect(const RgbdView& view) override;
  [[nodiscard]] const std::vector<SubClass>& classes() const override { return classes_; }
  void reset() override;

  /// Columns of the crop rows as taken in the last frame; empty before the first, or when no row
  /// stood out.
  [[nodiscard]] const std::vector<double>& crop_row_u_px() const { return crop_row_u_px_; }

 private:
  /// Plants with mask and stem; their classes are still unset.
  [[nodiscard]] std::vector<Instance> find_plants(const RgbdView& view) const;
  void update_rows(const RgbdView& view, const std::vector<Instance>& plants);
  [[nodiscard]] double crop_probability_of(const Instance& plant, const RgbdView& view) const;

  IndexDetectorParameters parameters_;
  std::vector<SubClass> classes_;
  std::vector<double> row_profile_;  ///< over one row spacing
  std::vector<double> crop_row_u_px_;
};

}  // namespace furrow::vision
