#pragma once

#include <array>
#include <string_view>

namespace furrow::experiments {

/// One field of two tables of Ahmadi, Halstead, Smitt, McCool: "BonnBot-I Plus" (2024), arXiv
/// 2405.09118. Table tab:realPlanning: nOTSP with static division, loss in %, travel of an axis in
/// m (mean and spread). Table tab:weedCatsHits: treated share in %, at 1.0 m/s.
struct PaperFigures {
  std::string_view field;         ///< the paper's name
  std::string_view generated_as;  ///< our field of the same density; not the recording itself
  double weeds_per_m2;
  double segment_loss_pct;
  double segment_travel_m;
  double segment_travel_sd_m;
  double rolling_loss_pct;
  double rolling_travel_m;
  double rolling_travel_sd_m;
  double low_plain_pct;
  double low_biodiversity_pct;
  double high_plain_pct;
  double high_biodiversity_pct;
};

inline constexpr std::array<PaperFigures, 5> kPaperFigures = {{
    {"CN20", "cn20_like", 3.1, 0.0, 2.7, 0.2, 0.0, 2.0, 1.6, 73.3, 73.3, 56.6, 56.6},
    {"SB20-S1", "sb20_s1_like", 8.2, 0.0, 1.4, 0.2, 0.0, 1.9, 0.9, 47.5, 44.3, 56.0, 60.2},
    {"SB20-S2", "sb20_s2_like", 15.4, 11.9, 10.1, 0.9, 6.4, 4.1, 2.1, 42.5, 40.5, 53.5, 63.5},
    {"SB21-S1", "sb21_s1_like", 22.3, 17.2, 6.1, 5.3, 14.1, 2.8, 2.6, 18.0, 15.2, 19.1, 38.8},
    {"SB21-S2", "sb21_s2_like", 81.2, 38.2, 13.4, 8.2, 36.5, 5.2, 3.1, 7.0, 5.1, 7.0, 17.4},
}};

/// Null for a field that the paper has not.
[[nodiscard]] const PaperFigures* paper_figures(std::string_view generated_as);

}  // namespace furrow::experiments
