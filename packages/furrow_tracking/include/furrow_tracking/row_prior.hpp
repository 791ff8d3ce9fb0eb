#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_tracking/track.hpp"

namespace furrow::tracking {

struct RowPriorParameters {
  bool row_prior = false;
  double row_sd_m = 0.012;
  double row_gap_m = 0.15;
  double row_min_crops = 4.0;
  double row_contrast = 3.0;
  double row_off_share = 0.02;
  double row_max_log_odds = 3.0;

  void visit(ParameterVisitor& v);
};

/// Class evidence from the place of a plant. Crops stand in rows along F's x, weeds anywhere. The
/// rows are modes of the lateral density of confirmed crops (Gaussian kernel). Each row has a crop
/// density; the field has a weed density. Bayes' rule then gives
///   log P(crop | y) / P(weed | y) = log((sum_k c_k N(y; y_k, s_k) + c_off) / w)
/// with c_k crops per metre of row k, c_off crops per m2 that stand anywhere, w weeds per m2.
class RowPrior {
 public:
  struct Row {
    double y_m = 0.0;
    double sd_m = 0.0;
    double crops_per_m = 0.0;
  };

  explicit RowPrior(const RowPriorParameters& parameters);

  /// Learns from the confirmed tracks, by the evidence of their views alone. Without a row or
  /// without length there is no evidence at any place.
  void learn(std::span<const Track> tracks);
  /// Within +-row_max_log_odds; 0 while no row is known.
  [[nodiscard]] double log_odds(double y_m) const;

  [[nodiscard]] const std::vector<Row>& rows() const { return rows_; }
  [[nodiscard]] double weeds_per_m2() const { return weeds_per_m2_; }

 private:
  struct Sample {
    double y_m;
    double crop;  ///< P(crop | views)
  };
  void smooth_density();
  void find_rows(double length_m);
  void count_weeds(double length_m);

  RowPriorParameters parameters_;
  std::vector<Sample> samples_;  // in the order of y
  std::vector<double> kernel_;   // from its middle on, over the cells of a grid across
  std::vector<double> counts_;   // crops by cell
  std::vector<double> density_;  // smoothed
  std::vector<Row> rows_;
  double weeds_per_m2_ = 0.0;
  double crops_off_per_m2_ = 0.0;
};

}  // namespace furrow::tracking
