#include "furrow_components/track_conversion.hpp"

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

}  // namespace

furrow_msgs::msg::Track to_msg(const tracking::Track& track, std::span<const std::string> species) {
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
  if (const int voted = track.species(); voted >= 0) {
    message.species(species[static_cast<std::size_t>(voted)]);
  }
  message.views(static_cast<std::uint32_t>(track.views));
  message.first_seen(graph::to_msg(track.first_seen));
  message.last_seen(graph::to_msg(track.last_seen));
  return message;
}

}  // namespace furrow::components
