#include "furrow_components/track_conversion.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "furrow_components/conversions.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/enums.hpp"

namespace furrow::components {
namespace {

msgs::TrackState track_state(tracking::TrackState state) {
  switch (state) {
    case tracking::TrackState::kTentative:
      return msgs::TrackState::kTentative;
    case tracking::TrackState::kConfirmed:
      return msgs::TrackState::kConfirmed;
    case tracking::TrackState::kCoasting:
      return msgs::TrackState::kCoasting;
    case tracking::TrackState::kEnded:
      break;
  }
  return msgs::TrackState::kDeleted;
}

std::vector<furrow_msgs::msg::SpeciesProbability> species_of(const tracking::Track& track,
                                                             const SpeciesNames& species) {
  constexpr float kLeast = 0.005F;
  std::vector<furrow_msgs::msg::SpeciesProbability> result;
  const auto entries = species.entries();
  for (std::size_t i = 0; i < std::min(track.species_probability.size(), entries.size()); ++i) {
    if (!(track.species_probability[i] >= kLeast)) continue;
    auto& share = result.emplace_back();
    share.species(entries[i].name);
    share.crop(entries[i].crop);
    share.probability(track.species_probability[i]);
  }
  std::ranges::stable_sort(
      result, [](const auto& a, const auto& b) { return a.probability() > b.probability(); });
  return result;
}

}  // namespace

furrow_msgs::msg::Track to_msg(const tracking::Track& track, const SpeciesNames& species) {
  furrow_msgs::msg::Track message;
  message.id(static_cast<std::int64_t>(track.id));
  message.state(msgs::to_msg(track_state(track.state)));
  message.confirmed(track.confirmed);
  message.position(to_point(track.p_F_m));
  message.covariance_xx_m2(track.covariance_F_m2(0, 0));
  message.covariance_xy_m2(track.covariance_F_m2(0, 1));
  message.covariance_yy_m2(track.covariance_F_m2(1, 1));
  message.radius_m(track.radius_m);
  message.area_mm2(track.area_mm2);
  message.crop_probability(track.class_probability[0]);
  message.species(species_of(track, species));
  message.leaves(static_cast<std::uint8_t>(std::clamp(std::lround(track.leaves), 0L, 255L)));
  message.views(static_cast<std::uint32_t>(track.views));
  message.first_seen(graph::to_msg(track.first_seen));
  message.last_seen(graph::to_msg(track.last_seen));
  return message;
}

}  // namespace furrow::components
