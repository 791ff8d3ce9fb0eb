#include "furrow_components/run_record_conversion.hpp"

#include <algorithm>
#include <cstdint>

#include "furrow_components/conversions.hpp"
#include "furrow_components/field_conversion.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/enums.hpp"

namespace furrow::components {
namespace {

using ledger::Action;
using ledger::Reason;

using Axes = std::span<const geometry::AxisModel>;

int axis_index(Axes axes, const std::string& name) {
  const auto it = std::ranges::find(axes, name, &geometry::AxisModel::name);
  return it == axes.end() ? -1 : static_cast<int>(it - axes.begin());
}

/// Why a track is left; kNone: it is not.
Reason reason_of(msgs::DecisionKind decision) {
  using msgs::DecisionKind;
  switch (decision) {
    case DecisionKind::kTreat:
      return Reason::kNone;
    case DecisionKind::kUnreachable:
      return Reason::kUnreachable;
    case DecisionKind::kLowPriority:
      return Reason::kLowPriority;
    case DecisionKind::kProtectedCrop:
      return Reason::kProtectedCrop;
    case DecisionKind::kOutside:
      return Reason::kOutside;
    case DecisionKind::kStale:
      return Reason::kStale;
    case DecisionKind::kFault:
      return Reason::kFault;
    case DecisionKind::kUnconfirmed:
      return Reason::kUnconfirmed;
    case DecisionKind::kUnsure:
      return Reason::kUnsure;
  }
  return Reason::kNone;
}

/// Why a driver skipped a stop; kNone: it did not.
Reason reason_of(msgs::AxisEventKind event) {
  using msgs::AxisEventKind;
  switch (event) {
    case AxisEventKind::kUnreachable:
      return Reason::kUnreachable;
    case AxisEventKind::kStale:
      return Reason::kStale;
    case AxisEventKind::kProtectedCrop:
      return Reason::kProtectedCrop;
    case AxisEventKind::kFault:
      return Reason::kFault;
    case AxisEventKind::kInactive:
      return Reason::kInactive;
    case AxisEventKind::kSprayed:
    case AxisEventKind::kDryRun:
    case AxisEventKind::kSafeState:
    case AxisEventKind::kReset:
    case AxisEventKind::kResetRefused:
      break;
  }
  return Reason::kNone;
}

ledger::Appraisal to_appraisal(const furrow_msgs::msg::Appraisal& message) {
  return {.scheme = message.scheme(),
          .species = message.species(),
          .species_probability = message.species_probability(),
          .unknown_probability = message.unknown_probability(),
          .area_mm2 = message.area_mm2(),
          .leaves = message.leaves(),
          .beta = message.beta(),
          .class_weight = message.class_weight(),
          .crop_distance_m = message.crop_distance_m(),
          .crop_proximity = message.crop_proximity(),
          .worth = message.worth(),
          .threshold = message.threshold()};
}

Result<ledger::Decision> to_decision(const furrow_msgs::msg::Decision& message, Axes axes) {
  const auto kind = msgs::from_msg(message.decision());
  if (!kind.ok()) return kind.error();
  ledger::Decision decision{.time = graph::from_msg(message.stamp()),
                            .track_id = message.track_id()};
  decision.reason = reason_of(*kind);
  decision.action = decision.reason == Reason::kNone ? Action::kTreat : Action::kLeave;
  if (decision.action == Action::kTreat) decision.axis = axis_index(axes, message.axis());
  if (message.appraisal().valid()) decision.appraisal = to_appraisal(message.appraisal());
  return decision;
}

ledger::TrackView to_track_view(const furrow_msgs::msg::Track& message) {
  const bool crop = message.crop_probability() > 0.5;
  ledger::TrackView view{.id = message.id(),
                         .p_F_m = from_point(message.position()).head<2>(),
                         .kind = crop ? field::PlantKind::kCrop : field::PlantKind::kWeed,
                         .confirmed = message.confirmed(),
                         .leaves = message.leaves(),
                         .radius_m = message.radius_m(),
                         .area_mm2 = message.area_mm2()};
  for (const auto& species : message.species()) {
    if (species.crop() != crop || !(species.probability() > view.species_probability)) continue;
    view.species = species.species();
    view.species_probability = species.probability();
  }
  return view;
}

Status add_decisions(const furrow_msgs::msg::RunRecord& message, Axes axes,
                     ledger::RunRecord& record) {
  for (const auto& entry : message.decisions()) {
    const auto decision = to_decision(entry, axes);
    if (!decision.ok()) return decision.error();
    record.decisions.push_back(*decision);
  }
  for (const auto& event : message.events()) {
    const auto kind = msgs::from_msg(event.event());
    if (!kind.ok()) return kind.error();
    // What a driver did with a stop is final: it overrides what the planner decides afterwards. A
    // valve that was opened and gave nothing is then a fault of the machine.
    const Reason reason = reason_of(*kind);
    const bool sprayed = *kind == msgs::AxisEventKind::kSprayed;
    if (reason == Reason::kNone && !sprayed) continue;
    for (const std::int64_t track : event.track_ids()) {
      record.decisions.push_back({.time = graph::from_msg(message.header().stamp()),
                                  .track_id = track,
                                  .action = sprayed ? Action::kTreat : Action::kLeave,
                                  .reason = reason,
                                  .axis = axis_index(axes, event.axis())});
    }
  }
  return {};
}

void add_true_sprays(const furrow_msgs::msg::RunRecord& message, Axes axes,
                     ledger::RunRecord& record) {
  for (const auto& spray : message.sprays()) {
    record.sprays.push_back({.time = graph::from_msg(spray.header().stamp()),
                             .axis = axis_index(axes, spray.axis()),
                             .p_F_m = from_point(spray.centre()).head<2>(),
                             .radius_m = spray.radius_m(),
                             .aim_F_m = from_point(spray.aim()).head<2>(),
                             .track_ids = spray.track_ids(),
                             .commanded = spray.stop_id() != 0});
  }
}

/// The openings of the valves. Where they landed is known only as the drivers predicted it.
void add_driver_sprays(const furrow_msgs::msg::RunRecord& message, Axes axes,
                       ledger::RunRecord& record) {
  for (const auto& event : message.events()) {
    const int axis = axis_index(axes, event.axis());
    if (event.event() != msgs::AxisEventKind::kSprayed || axis < 0) continue;
    record.sprays.push_back(
        {.time = graph::from_msg(event.header().stamp()),
         .axis = axis,
         .p_F_m = from_point(event.landing()).head<2>(),
         .radius_m = axes[static_cast<std::size_t>(axis)].nozzle.footprint_radius_m,
         .aim_F_m = from_point(event.aim()).head<2>(),
         .track_ids = event.track_ids()});
  }
}

void add_paths(const furrow_msgs::msg::RunRecord& message, Axes axes, ledger::RunRecord& record) {
  record.info.axis_travel_m.assign(axes.size(), 0.0);
  for (const auto& path : message.paths()) {
    const int axis = axis_index(axes, path.axis());
    if (axis < 0) continue;
    record.info.axis_travel_m[static_cast<std::size_t>(axis)] = path.travel_m();
    ledger::RouteView& route = record.routes.emplace_back();
    route.axis = axis;
    for (const auto& point : path.points()) route.p_F_m.push_back(from_point(point).head<2>());
  }
}

}  // namespace

Result<ledger::RunRecord> from_msg(const furrow_msgs::msg::RunRecord& message, Axes axes) {
  ledger::RunRecord record;
  record.info.speed_mps = message.mean_speed_mps();
  record.info.distance_m = message.distance_m();
  record.info.duration_s = message.duration_s();
  for (const auto& track : message.tracks()) record.tracks.push_back(to_track_view(track));
  if (const Status added = add_decisions(message, axes, record); !added.ok()) return added.error();
  if (message.ground_truth()) {
    add_true_sprays(message, axes, record);
  } else {
    add_driver_sprays(message, axes, record);
  }
  add_paths(message, axes, record);
  return record;
}

Result<ledger::Ledger> account(const furrow_msgs::msg::RunRecord& message,
                               const ledger::RunRecord& record, const std::string& name) {
  field::FieldModel field = from_msg(message.field());
  if (message.ground_truth()) return ledger::account(field, record);
  if (field.name.empty()) field.name = name;
  field.source = "tracks of the robot, no ground truth";
  return ledger::account_tracks(field, record);
}

}  // namespace furrow::components
