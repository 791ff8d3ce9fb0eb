#pragma once

#include <vector>

namespace furrow::vision {

/// A plant's column and how much it says about where the rows are.
struct RowVote {
  double u_px = 0.0;
  double weight = 0.0;
};

/// Adds one frame's votes to the profile over the phases of a row spacing, after fading what it
/// held by `memory`. @pre spacing_px > 0, sd_px > 0. An empty profile is made.
void add_row_votes(const std::vector<RowVote>& votes, double spacing_px, double sd_px,
                   double memory, std::vector<double>& profile);

/// Columns of the rows in [-margin_px, width_px + margin_px]; none when the best phase does not
/// exceed the profile's mean by `contrast_min`.
[[nodiscard]] std::vector<double> rows_of_profile(const std::vector<double>& profile,
                                                  double spacing_px, double width_px,
                                                  double margin_px, double contrast_min);

}  // namespace furrow::vision
