#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "appraisal_conversion.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_components/pose_buffer.hpp"
#include "furrow_geometry/ground_view.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_planning/harmfulness.hpp"
#include "furrow_planning/observation_view.hpp"
#include "lateral_axis.hpp"
#include "plan_conversion.hpp"
#include "planner_parameters.hpp"
#include "speed_requests.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;
using furrow_msgs::msg::Appraisal;
using furrow_msgs::msg::Track;

/// Decides which weeds to treat, and routes the axes over them.
class PlannerComponent final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Routes the axes over the weeds to treat; decides about every track.")
        .parameters<PlannerComponentParameters>()
        .input<topics::Tracks>()
        .input<topics::RobotOdometry>()
        .input<topics::AxisState>(graph::Need::kOptional)
        .output<topics::Plan>()
        .output<topics::PlannerHeartbeat>()
        .output<topics::SpeedRequest>();
  }

  explicit PlannerComponent(graph::Context& context)
      : context_(context),
        parameters_(completed(context.parameters<PlannerComponentParameters>())),
        tool_(geometry::load_tool_model(parameters_.tool_file)),
        axes_(lateral_axes(tool_)),
        conversion_(axes_),
        seen_x_m_(tool_.cameras.empty() ? 0.0 : geometry::rear_view_x_m(tool_.cameras.front())),
        harmfulness_(parameters_.harmfulness),
        view_(planning::make_observation_view(parameters_.planner, specs(axes_))),
        speed_requests_(context, parameters_.govern_speed, parameters_.governor,
                        parameters_.planner.speed_mps, specs(axes_)),
        out_(context.output<topics::Plan>()),
        heartbeat_out_(context.output<topics::PlannerHeartbeat>()) {
    context.input<topics::RobotOdometry>([this](const auto& message) {
      if (const Status added = poses_.add(from_msg(*message)); !added.ok()) {
        context_.warn("bad_odometry", added.error().message + "; it was not used");
      }
    });
    context.input<topics::AxisState>([this](const auto& state) { watch(*state); });
    context.input<topics::Tracks>([this](const auto& tracks) { plan(*tracks); });
    context.every(Duration::seconds(1.0 / parameters_.heartbeat_rate_hz),
                  [this](Time now) { beat(now); });
  }

 private:
  void plan(const furrow_msgs::msg::Tracks& tracks) {
    const Time now = context_.now();
    const auto base = poses_.at(now, Duration::seconds(parameters_.max_pose_age_s));
    if (!base.ok()) {
      no_plan("no_pose", graph::HealthLevel::kWarn, base.error());
      return;
    }
    // A stamp in the future is as stale as one equally far in the past.
    const Time seen = graph::from_msg(tracks.header().stamp());
    const bool stale = std::abs((now - seen).to_seconds()) > parameters_.max_tracks_age_s;
    last_tracks_ = now;
    take(tracks, stale);
    const planning::RobotState robot{base->X_FB.x_m, base->X_FB.y_m, base->speed_mps};
    if (const Status moved = view_->advance(robot, robot.x_m + seen_x_m_); !moved.ok()) {
      no_plan("bad_odometry", graph::HealthLevel::kWarn, moved.error());
      return;
    }
    if (robot.speed_mps > 0.0) {
      speed_requests_.consider(robot, *view_);
    } else {
      context_.count("standing_or_reversing");
    }
    const auto planned = view_->replan();
    if (!planned.ok()) {
      no_plan("no_plan", graph::HealthLevel::kError, planned.error());
      return;
    }
    if (*planned) context_.count("replanned");
    if (stale) {
      context_.count("stale_tracks");
      context_.health(graph::HealthLevel::kWarn, "tracks are stale; their weeds are not treated");
    } else {
      context_.health(graph::HealthLevel::kOk, "");
    }
    publish(*base, tracks.header().stamp());
  }

  void no_plan(const char* counter, graph::HealthLevel level, const Error& cause) {
    context_.count(counter);
    context_.health(level, cause.message + "; no plan was published");
  }

  void beat(Time now) {
    furrow_msgs::msg::Heartbeat message;
    message.header(header(now, ""));
    message.sender(context_.name());
    message.count(++beats_);
    heartbeat_out_.publish(std::move(message));
    // Without a request the robot keeps its own speed.
    if (const auto base = poses_.at(now, Duration::seconds(parameters_.max_pose_age_s));
        base.ok()) {
      speed_requests_.publish(*base);
    }
    if (last_tracks_ && (now - *last_tracks_).to_seconds() > parameters_.max_tracks_age_s) {
      context_.count("tracks_missing");
      context_.health(graph::HealthLevel::kWarn, "no tracks received; no weed is treated");
      last_tracks_.reset();
    }
  }

  void take(const furrow_msgs::msg::Tracks& tracks, bool stale) {
    crops_.clear();
    left_standing_.clear();
    deleted_.clear();
    invalid_.clear();
    unsure_.clear();
    appraisals_.clear();
    for (const Track& track : tracks.tracks()) {
      if (const auto state = msgs::from_msg(track.state()); !state.ok()) {
        context_.warn("unknown_values", state.error().message + "; the track is not treated");
      }
      conversion_.seen(track.id(), graph::from_msg(track.last_seen()));
      // Unsure plants do not count as crops: a weed beside them is not the more harmful.
      const planning::CropPhenotype crop{from_point(track.position()).head<2>(), track.area_mm2()};
      // An invalid crop would take the weight from every weed near it.
      const bool valid = crop.p_F.allFinite() && std::isfinite(crop.area_mm2) && crop.area_mm2 >= 0;
      if (valid && alive(track) && is_crop(track)) crops_.push_back(crop);
    }
    for (const Track& track : tracks.tracks()) {
      if (!alive(track)) {
        forget(track.id());
      } else if (is_protected(track)) {
        view_->remove(track.id());
        if (!is_crop(track)) unsure_.push_back(track.id());
        count_if_bad(view_->update_protected(
            {.id = track.id(), .p_F = from_point(track.position()).head<2>()}));
      } else if (stale || !msgs::from_msg(track.state()).ok()) {
        // A spray that an axis is committed to is not withdrawn.
        if (view_->remove(track.id())) invalid_.push_back(track.id());
      } else {
        view_->remove_protected(track.id());
        update_weed(track);
      }
    }
  }

  /// Also of an unknown state: a crop must stay protected.
  [[nodiscard]] bool alive(const Track& track) const {
    return (track.confirmed() || parameters_.treat_unconfirmed) &&
           track.state() != msgs::TrackState::kDeleted;
  }
  [[nodiscard]] bool is_crop(const Track& track) const {
    return track.crop_probability() >= parameters_.crop_threshold;
  }
  /// A crop, or too likely one to be treated.
  [[nodiscard]] bool is_protected(const Track& track) const {
    return track.crop_probability() >= parameters_.unsure_threshold;
  }

  // A target that the robot has passed keeps its outcome: remove() returns false. A track that is
  // deleted earlier was confirmed too early; the ledger calls it unconfirmed.
  void forget(std::int64_t id) {
    if (view_->remove(id)) deleted_.push_back(id);
    view_->remove_protected(id);
  }

  void update_weed(const Track& track) {
    const Eigen::Vector2d p_F = from_point(track.position()).head<2>();
    weed_species(track, shares_);
    const auto weight = harmfulness_.weigh(
        {.species = {}, .p_F = p_F, .area_mm2 = track.area_mm2(), .distribution = shares_}, crops_);
    if (!weight.ok()) {
      context_.warn("bad_tracks", weight.error().message + "; the track is not treated");
      view_->remove(track.id());
      invalid_.push_back(track.id());
      return;
    }
    appraisals_.emplace_back(track.id(), appraisal(*weight, track, parameters_.harmfulness));
    if (weight->leave) {
      view_->remove(track.id());
      left_standing_.push_back(track.id());
      return;
    }
    count_if_bad(view_->update(
        {.id = track.id(), .p_F = p_F, .weight = weight->weight, .radius_m = track.radius_m()}));
  }

  void count_if_bad(const Status& status) {
    if (!status.ok()) context_.warn("bad_tracks", status.error().message + "; it was not used");
  }

  void watch(const furrow_msgs::msg::AxisState& state) {
    const auto cause = msgs::from_msg(state.cause());
    if (!cause.ok()) {
      context_.warn("unknown_values", cause.error().message + "; the axis is out of service");
    }
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      if (axes_[i].model.name != state.axis()) continue;
      // An axis with an unknown cause is not in service either.
      const bool in_service = cause.ok() && *cause == msgs::SafetyCause::kNone;
      count_if_bad(view_->set_in_service(i, in_service));
    }
  }

  void publish(const BaseOdometry& base, const builtin_interfaces::msg::Time& stamp) {
    using msgs::DecisionKind;
    furrow_msgs::msg::Plan message = conversion_.to_msg(view_->plan(), base, stamp);
    const auto decide = [&](const std::vector<std::int64_t>& ids, DecisionKind decision) {
      for (const std::int64_t id : ids) {
        message.decisions().push_back(conversion_.to_msg(base.stamp, id, decision));
      }
    };
    decide(left_standing_, DecisionKind::kLowPriority);
    decide(invalid_, DecisionKind::kStale);
    decide(deleted_, DecisionKind::kUnconfirmed);
    decide(unsure_, DecisionKind::kUnsure);
    outcomes_.clear();
    view_->take_outcomes(outcomes_);
    for (const planning::TargetOutcome& outcome : outcomes_) {
      message.decisions().push_back(conversion_.to_msg(
          base.stamp, outcome.id, decision_kind(outcome.decision), outcome.axis));
    }
    add_appraisals(message);
    out_.publish(std::move(message));
  }

  /// To the decisions about weeds of the newest tracks. One about a track that is gone has none.
  void add_appraisals(furrow_msgs::msg::Plan& message) {
    std::ranges::sort(appraisals_, {}, &std::pair<std::int64_t, Appraisal>::first);
    for (auto& decision : message.decisions()) {
      const auto found = std::ranges::lower_bound(appraisals_, decision.track_id(), {},
                                                  &std::pair<std::int64_t, Appraisal>::first);
      if (found == appraisals_.end() || found->first != decision.track_id()) continue;
      decision.appraisal(found->second);
    }
  }

  graph::Context& context_;
  PlannerComponentParameters parameters_;
  geometry::ToolModel tool_;
  std::vector<LateralAxis> axes_;
  PlanConversion conversion_;
  double seen_x_m_;
  planning::HarmfulnessModel harmfulness_;
  std::unique_ptr<planning::ObservationView> view_;
  SpeedRequests speed_requests_;
  graph::Output<topics::Plan> out_;
  graph::Output<topics::PlannerHeartbeat> heartbeat_out_;
  std::uint64_t beats_ = 0;
  std::optional<Time> last_tracks_;  ///< arrival of the newest tracks; empty once they are stale
  PoseBuffer poses_{Duration::seconds(2.0)};
  std::vector<planning::CropPhenotype> crops_;
  // Of the newest tracks:
  std::vector<std::int64_t> left_standing_;  ///< left for biodiversity
  std::vector<std::int64_t> invalid_;        ///< weeds with invalid numbers or stale tracks
  std::vector<std::int64_t> deleted_;        ///< targets whose track was deleted
  std::vector<std::int64_t> unsure_;         ///< neither crop nor sure enough a weed
  std::vector<std::pair<std::int64_t, Appraisal>> appraisals_;  ///< of the weeds, by track
  std::vector<planning::SpeciesShare> shares_;                  ///< of the track at hand
  std::vector<planning::TargetOutcome> outcomes_;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::PlannerComponent>("planner");
}
