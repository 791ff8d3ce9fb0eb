#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "furrow_core/point_grid.hpp"
#include "furrow_ledger/run_record.hpp"

namespace furrow::ledger {

inline constexpr std::size_t kNoIndex = static_cast<std::size_t>(-1);

/// Which track stands for which plant.
struct Association {
  std::vector<std::size_t> track_of_plant;           ///< index of the track; kNoIndex
  std::vector<double> distance_m;                    ///< of that track to the plant
  std::vector<std::size_t> plant_of_track;           ///< also of duplicates; kNoIndex
  std::vector<std::vector<std::size_t>> duplicates;  ///< per plant, further tracks near it
  std::int64_t tracks_without_plant = 0;
};

/// Pairs sorted tracks and plants as account() describes. `grid` holds the plants' stems.
[[nodiscard]] Association associate(const std::vector<std::int64_t>& plant_ids,
                                    const PointGrid<Eigen::Vector2d>& grid,
                                    const std::vector<TrackView>& tracks, double radius_m);

}  // namespace furrow::ledger
