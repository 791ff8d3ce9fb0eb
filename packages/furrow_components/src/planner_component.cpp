#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_components/conversions.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_components/pose_buffer.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_planning/harmfulness.hpp"
#include "furrow_planning/observation_view.hpp"
#include "speed_requests.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;
using furrow_msgs::msg::Track;

struct Parameters {
  std::string tool_file;
  std::string species_file;
  double crop_threshold = 0.5;
  bool treat_unconfirmed = false;
  double max_pose_age_s = 0.2;
  double max_tracks_age_s = 2.0;
  double heartbeat_rate_hz = 50.0;
  bool govern_speed = false;
  planning::PlannerParameters planner;
  planning::HarmfulnessParameters harmfulness;
  planning::SpeedGovernorParameters governor;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
    v.visit({.name = "species_file",
             .description = "table of species with their factors; empty: the lists below"},
            species_file);
    v.visit({.name = "crop_threshold",
             .description = "tracks at or above this probability are crop",
             .min = 0.0,
             .max = 1.0},
            crop_threshold);
    v.visit({.name = "treat_unconfirmed",
             .description = "whether weeds count that were seen too few times to be believed: a "
                            "spray on nothing against a weed that stays"},
            treat_unconfirmed);
    v.visit({.name = "max_pose_age_s",
             .unit = "s",
             .description = "without newer odometry nothing is planned",
             .min = 0.01,
             .max = 10.0},
            max_pose_age_s);
    v.visit({.name = "max_tracks_age_s",
             .unit = "s",
             .description = "targets whose newest view is older are stale: they are not treated "
                            "until they have been seen again",
             .min = 0.05,
             .max = 60.0},
            max_tracks_age_s);
    v.visit({.name = "heartbeat_rate_hz",
             .unit = "Hz",
             .description = "that the planner is alive, for those who act on its plans",
             .min = 1.0,
             .max = 1000.0},
            heartbeat_rate_hz);
    v.visit({.name = "govern_speed",
             .description = "whether the robot is asked for the speed at which the axes keep up "
                            "with the weeds ahead, speed_mps or less, and plans hold for that"},
            govern_speed);
    planner.visit(v);
    PrefixedVisitor harmfulness_visitor(v, "harmfulness_");
    harmfulness.visit(harmfulness_visitor);
    PrefixedVisitor governor_visitor(v, "governor_");
    governor.visit(governor_visitor);
  }
};

planning::HarmfulnessParameters with_species(planning::HarmfulnessParameters parameters,
                                             const std::string& file) {
  if (file.empty()) return parameters;
  parameters.species.clear();
  parameters.beta.clear();
  parameters.class_weight.clear();
  const field::SpeciesTable table = load_species(file);
  for (const field::Species& species : table.all()) {
    if (species.kind != field::PlantKind::kWeed) continue;
    parameters.species.push_back(species.name);
    parameters.beta.push_back(species.beta);
    parameters.class_weight.push_back(species.priority);
  }
  return parameters;
}

/// A lateral axis as the planner sees it: by the y of its nozzle in the base frame.
struct LateralAxis {
  const geometry::AxisModel* model;

  [[nodiscard]] double nozzle_y_m(double q_m) const { return model->nozzle_position_B(q_m).y(); }
  [[nodiscard]] double position_m(double nozzle_y) const {
    return (nozzle_y - model->p_BN0.y()) / model->direction_B.y();
  }
  [[nodiscard]] planning::AxisSpec spec() const {
    const auto [lower, upper] =
        std::minmax({nozzle_y_m(model->lower_m), nozzle_y_m(model->upper_m)});
    return {.offset_x_m = model->p_BN0.x(),
            .lower_m = lower,
            .upper_m = upper,
            .max_velocity_mps = model->max_velocity_mps,
            .max_acceleration_mps2 = model->max_acceleration_mps2};
  }
};

std::vector<LateralAxis> lateral_axes(const geometry::ToolModel& tool) {
  std::vector<LateralAxis> axes;
  for (const geometry::AxisModel& axis : tool.axes) {
    if (std::abs(axis.direction_B.y()) < 0.99) {
      throw ConfigError("axis '" + axis.name + "' is not lateral: the planner needs axes along y");
    }
    axes.push_back({&axis});
  }
  return axes;
}

std::vector<planning::AxisSpec> specs(const std::vector<LateralAxis>& axes) {
  std::vector<planning::AxisSpec> list;
  list.reserve(axes.size());
  for (const LateralAxis& axis : axes) list.push_back(axis.spec());
  return list;
}

const Parameters& checked(const Parameters& parameters) {
  if (parameters.govern_speed &&
      (parameters.planner.view != "rolling" || parameters.planner.fire_while_moving)) {
    throw ConfigError("govern_speed needs the rolling view, without fire_while_moving");
  }
  return parameters;
}

/// The hindmost x in the base frame that the camera still sees: plants behind it have been seen.
double camera_rear_x_m(const geometry::ToolModel& tool) {
  if (tool.cameras.empty()) return 0.0;
  const geometry::CameraModel& model = tool.cameras.front();
  const geometry::PinholeCamera camera(model.intrinsics);
  double rear_m = INFINITY;
  for (const double u : {0.0, model.intrinsics.width_px - 1.0}) {
    for (const double v : {0.0, model.intrinsics.height_px - 1.0}) {
      const Eigen::Vector3d ray_B = model.X_BC.linear() * camera.unproject({u, v}, 1.0);
      if (ray_B.z() >= 0.0) continue;
      const Eigen::Vector3d origin_B = model.X_BC.translation();
      rear_m = std::min(rear_m, (origin_B - origin_B.z() / ray_B.z() * ray_B).x());
    }
  }
  return std::isfinite(rear_m) ? rear_m : 0.0;
}

/// What the ledger calls a decision of the planner.
std::string decision_name(planning::Decision decision) {
  using planning::Decision;
  switch (decision) {
    case Decision::kBehind:
      return "unreachable";
    case Decision::kInvalid:
    case Decision::kDuplicate:
      return "stale";
    case Decision::kAxisFault:
      return "fault";
    default:
      return std::string(planning::to_string(decision));
  }
}

/// Decides which weeds matter and routes the axes over them.
class PlannerComponent final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Routes for the axes over the weeds that matter; a decision for every track.")
        .parameters<Parameters>()
        .input<topics::Tracks>()
        .input<topics::RobotOdometry>()
        .input<topics::AxisState>(graph::Need::kOptional)
        .output<topics::Plan>()
        .output<topics::PlannerHeartbeat>()
        .output<topics::SpeedRequest>();
  }

  explicit PlannerComponent(graph::Context& context)
      : context_(context),
        parameters_(context.parameters<Parameters>()),
        tool_(geometry::load_tool_model(parameters_.tool_file)),
        axes_(lateral_axes(tool_)),
        seen_x_m_(camera_rear_x_m(tool_)),
        harmfulness_(with_species(parameters_.harmfulness, parameters_.species_file)),
        view_(planning::make_observation_view(checked(parameters_).planner, specs(axes_))),
        speed_requests_(context, parameters_.govern_speed, parameters_.governor,
                        parameters_.planner.speed_mps, specs(axes_)),
        out_(context.output<topics::Plan>()),
        heartbeat_out_(context.output<topics::PlannerHeartbeat>()) {
    context.input<topics::RobotOdometry>([this](const auto& message) {
      if (!poses_.add(from_msg(*message)).ok()) context_.count("bad_odometry");
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
      context_.count("no_pose");
      context_.health(graph::HealthLevel::kWarn, base.error().message);
      return;
    }
    // A stamp from the future is no fresher than one equally far in the past.
    const Time seen = graph::from_msg(tracks.header().stamp());
    const bool stale = std::abs((now - seen).to_seconds()) > parameters_.max_tracks_age_s;
    last_tracks_ = now;
    take(tracks, stale);
    const planning::RobotState robot{base->X_FB.x_m, base->X_FB.y_m, base->speed_mps};
    if (const Status moved = view_->advance(robot, robot.x_m + seen_x_m_); !moved.ok()) {
      context_.count("standing_or_reversing");
      context_.health(graph::HealthLevel::kWarn, moved.error().message);
      return;
    }
    speed_requests_.consider(robot, *view_);
    const auto planned = view_->replan();
    if (!planned.ok()) {
      context_.count("no_plan");
      context_.health(graph::HealthLevel::kError, planned.error().message);
      return;
    }
    if (*planned) context_.count("replanned");
    if (stale) {
      context_.count("stale_tracks");
      context_.health(graph::HealthLevel::kWarn, "the targets are stale");
    } else {
      context_.health(graph::HealthLevel::kOk, "");
    }
    publish(*base, tracks.header().stamp());
  }

  void beat(Time now) {
    furrow_msgs::msg::Heartbeat message;
    message.header(header(now, ""));
    message.sender(context_.name());
    message.count(++beats_);
    heartbeat_out_.publish(std::move(message));
    // Without a pose nothing is asked, and the robot goes by its own speed.
    if (const auto base = poses_.at(now, Duration::seconds(parameters_.max_pose_age_s));
        base.ok()) {
      speed_requests_.publish(*base);
    }
    if (last_tracks_ && (now - *last_tracks_).to_seconds() > parameters_.max_tracks_age_s) {
      context_.count("tracks_missing");
      context_.health(graph::HealthLevel::kWarn, "no tracks come: the targets are stale");
      last_tracks_.reset();
    }
  }

  void take(const furrow_msgs::msg::Tracks& tracks, bool stale) {
    crops_.clear();
    left_standing_.clear();
    lost_.clear();
    unsound_.clear();
    for (const Track& track : tracks.tracks()) {
      const planning::CropPhenotype crop{from_point(track.position()).head<2>(), track.area_mm2()};
      // One that is not sound would take the weight from every weed near it.
      const bool sound = crop.p_F.allFinite() && std::isfinite(crop.area_mm2) && crop.area_mm2 >= 0;
      if (sound && alive(track) && is_crop(track)) crops_.push_back(crop);
    }
    for (const Track& track : tracks.tracks()) {
      if (!alive(track)) {
        forget(track.id());
      } else if (stale && !is_crop(track)) {
        // What an axis is already committed to goes on.
        if (view_->remove(track.id())) unsound_.push_back(track.id());
      } else if (is_crop(track)) {
        view_->remove(track.id());
        count_if_bad(view_->update_protected(
            {.id = track.id(), .p_F = from_point(track.position()).head<2>()}));
      } else {
        view_->remove_protected(track.id());
        update_weed(track);
      }
    }
  }

  [[nodiscard]] bool alive(const Track& track) const {
    return (track.confirmed() || parameters_.treat_unconfirmed) && track.state() != kTrackEnded;
  }
  [[nodiscard]] bool is_crop(const Track& track) const {
    return track.crop_probability() >= parameters_.crop_threshold;
  }

  // A track that ended because it was left behind keeps its outcome; remove() then does nothing.
  // One that ends before was believed too early: the ledger calls it unconfirmed.
  void forget(std::int64_t id) {
    if (view_->remove(id)) lost_.push_back(id);
    view_->remove_protected(id);
  }

  void update_weed(const Track& track) {
    const Eigen::Vector2d p_F = from_point(track.position()).head<2>();
    const auto weight = harmfulness_.weigh(
        {.species = track.species(), .p_F = p_F, .area_mm2 = track.area_mm2()}, crops_);
    if (!weight.ok()) {
      context_.count("bad_tracks");
      view_->remove(track.id());
      unsound_.push_back(track.id());
      return;
    }
    if (weight->leave) {
      view_->remove(track.id());
      left_standing_.push_back(track.id());
      return;
    }
    count_if_bad(view_->update(
        {.id = track.id(), .p_F = p_F, .weight = weight->weight, .radius_m = track.radius_m()}));
  }

  void count_if_bad(const Status& status) {
    if (!status.ok()) context_.count("bad_tracks");
  }

  void watch(const furrow_msgs::msg::AxisState& state) {
    for (std::size_t i = 0; i < tool_.axes.size(); ++i) {
      if (tool_.axes[i].name != state.axis()) continue;
      const bool in_service = state.fault().empty();
      count_if_bad(view_->set_in_service(i, in_service));
    }
  }

  void publish(const BaseOdometry& base, const builtin_interfaces::msg::Time& stamp) {
    const planning::Plan& plan = view_->plan();
    furrow_msgs::msg::Plan message;
    message.header().stamp(stamp);
    message.header().frame_id(kFieldFrame);
    message.revision(++revision_);
    for (std::size_t i = 0; i < plan.routes.size(); ++i) {
      auto& route = message.routes().emplace_back();
      route.axis(tool_.axes[i].name);
      for (const planning::Stop& stop : plan.routes[i]) {
        route.stops().push_back(to_stop(plan, stop, axes_[i], base));
      }
    }
    for (const planning::TargetDecision& decision : plan.decisions) {
      message.decisions().push_back(
          to_decision(decision.id, decision.decision, decision.axis, base));
    }
    for (const std::int64_t id : left_standing_) {
      message.decisions().push_back(to_decision(id, planning::Decision::kLowPriority, -1, base));
    }
    for (const std::int64_t id : unsound_) {
      message.decisions().push_back(to_decision(id, planning::Decision::kInvalid, -1, base));
    }
    for (const std::int64_t id : lost_) {
      message.decisions().push_back(to_decision(id, planning::Decision::kInvalid, -1, base));
      message.decisions().back().decision("unconfirmed");
    }
    outcomes_.clear();
    view_->take_outcomes(outcomes_);
    for (const planning::TargetOutcome& outcome : outcomes_) {
      message.decisions().push_back(to_decision(outcome.id, outcome.decision, outcome.axis, base));
    }
    out_.publish(std::move(message));
  }

  furrow_msgs::msg::Stop to_stop(const planning::Plan& plan, const planning::Stop& stop,
                                 const LateralAxis& axis, const BaseOdometry& base) {
    furrow_msgs::msg::Stop message;
    message.id(++stop_id_);
    message.aim(to_point(stop.aim_F));
    message.axis_position_m(axis.position_m(stop.position_m));
    const double speed_mps = std::max(base.speed_mps, 1e-3);
    message.expected(graph::to_msg(
        base.stamp + Duration::seconds((stop.robot_x_m - base.X_FB.x_m) / speed_mps)));
    message.while_moving(stop.moving);
    const auto targets = plan.targets_of(stop);
    message.track_ids().assign(targets.begin(), targets.end());
    return message;
  }

  [[nodiscard]] furrow_msgs::msg::Decision to_decision(planning::TargetId id,
                                                       planning::Decision decision,
                                                       std::int32_t axis,
                                                       const BaseOdometry& base) const {
    furrow_msgs::msg::Decision message;
    message.stamp(graph::to_msg(base.stamp));
    message.track_id(id);
    message.decision(decision_name(decision));
    if (axis >= 0) message.axis(tool_.axes[static_cast<std::size_t>(axis)].name);
    return message;
  }

  graph::Context& context_;
  Parameters parameters_;
  geometry::ToolModel tool_;
  std::vector<LateralAxis> axes_;
  double seen_x_m_;
  planning::HarmfulnessModel harmfulness_;
  std::unique_ptr<planning::ObservationView> view_;
  SpeedRequests speed_requests_;
  graph::Output<topics::Plan> out_;
  graph::Output<topics::PlannerHeartbeat> heartbeat_out_;
  std::uint64_t beats_ = 0;
  std::optional<Time> last_tracks_;  ///< when tracks last came, until that is found too long ago
  PoseBuffer poses_{Duration::seconds(2.0)};
  std::vector<planning::CropPhenotype> crops_;
  std::vector<std::int64_t> left_standing_;  ///< on purpose, by the newest tracks
  std::vector<std::int64_t> unsound_;        ///< weeds whose numbers cannot be used, or are too old
  std::vector<std::int64_t> lost_;           ///< targets whose track the tracker gave up
  std::vector<planning::TargetOutcome> outcomes_;
  std::uint64_t revision_ = 0;
  std::int64_t stop_id_ = 0;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::PlannerComponent>("planner");
}
