#include "association.hpp"

#include <algorithm>
#include <tuple>

namespace furrow::ledger {
namespace {

struct Candidate {
  bool tentative;
  double distance_m;
  std::int64_t plant_id;
  std::size_t plant;
  std::size_t track;
  [[nodiscard]] auto key() const { return std::tie(tentative, distance_m, plant_id, track); }
};

}  // namespace

Association associate(const std::vector<std::int64_t>& plant_ids,
                      const PointGrid<Eigen::Vector2d>& grid, const std::vector<TrackView>& tracks,
                      double radius_m) {
  Association result;
  result.track_of_plant.assign(plant_ids.size(), kNoIndex);
  result.distance_m.assign(plant_ids.size(), 0.0);
  result.duplicates.resize(plant_ids.size());
  result.plant_of_track.assign(tracks.size(), kNoIndex);

  std::vector<Candidate> candidates;
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    grid.for_each_within(tracks[t].p_F_m, radius_m, [&](std::size_t plant, double distance_m) {
      candidates.push_back({!tracks[t].confirmed, distance_m, plant_ids[plant], plant, t});
    });
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.key() < b.key(); });

  for (const Candidate& candidate : candidates) {
    if (result.track_of_plant[candidate.plant] != kNoIndex) continue;
    if (result.plant_of_track[candidate.track] != kNoIndex) continue;
    result.track_of_plant[candidate.plant] = candidate.track;
    result.distance_m[candidate.plant] = candidate.distance_m;
    result.plant_of_track[candidate.track] = candidate.plant;
  }
  // The remaining tracks are duplicates of the nearest plant: candidates are sorted by distance.
  for (const Candidate& candidate : candidates) {
    if (result.plant_of_track[candidate.track] != kNoIndex) continue;
    result.plant_of_track[candidate.track] = candidate.plant;
    result.duplicates[candidate.plant].push_back(candidate.track);
  }
  result.tracks_without_plant =
      std::count(result.plant_of_track.begin(), result.plant_of_track.end(), kNoIndex);
  return result;
}

}  // namespace furrow::ledger
