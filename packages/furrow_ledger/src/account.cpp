#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>

#include "association.hpp"
#include "furrow_ledger/ledger.hpp"
#include "summary.hpp"
#include "validation.hpp"

namespace furrow::ledger {
namespace {

using field::Plant;
using field::PlantKind;

/// What sprays did to one plant. Indices into the sorted sprays; kNoIndex where there is none.
struct Sprayed {
  std::size_t landed = kNoIndex;  ///< the nearest whose footprint took the stem
  double landed_m = 0.0;
  std::size_t aimed = kNoIndex;  ///< the nearest of those aimed at the plant
  double aimed_m = 0.0;
  double error_m = 0.0;  ///< of that one's placement
};

auto key(const Spray& s) {
  return std::make_tuple(s.time.count_ns(), s.axis, s.p_F_m.x(), s.p_F_m.y(), s.aim_F_m.x(),
                         s.aim_F_m.y(), s.radius_m);
}
auto key(const TrackView& t) {
  return std::make_tuple(t.id, t.p_F_m.x(), t.p_F_m.y(), t.kind, t.confirmed, t.radius_m);
}
auto key(const Decision& d) {
  return std::make_tuple(d.track_id, d.time.count_ns(), d.action, d.reason, d.axis,
                         d.appraisal ? d.appraisal->worth : -1.0);
}
auto key(const Plant& p) {
  return std::make_tuple(p.p_F_m.x(), p.id);
}

template <class T>
std::vector<T> sorted(std::vector<T> items) {
  std::sort(items.begin(), items.end(), [](const T& a, const T& b) { return key(a) < key(b); });
  return items;
}

/// One account in the making: everything in one order, whatever the order of the input.
class Accountant {
 public:
  Accountant(const field::FieldModel& truth, const RunRecord& record,
             const AccountParameters& parameters)
      : parameters_(parameters),
        info_(record.info),
        plants_(sorted(truth.plants)),
        tracks_(sorted(record.tracks)),
        decisions_(sorted(record.decisions)),
        sprays_(sorted(record.sprays)) {
    ledger_.parameters = parameters;
    ledger_.length_m = truth.length_m;
    ledger_.width_m = truth.width_m;
    ledger_.row_y_m = truth.row_y_m;
    ledger_.summary.field = truth.name;
    ledger_.summary.source = truth.source;
  }

  Ledger run() {
    std::vector<Eigen::Vector2d> stems;
    std::vector<std::int64_t> ids;
    double cell_m =
        std::max({parameters_.association_radius_m, parameters_.partial_radius_m, 0.01});
    for (const Spray& spray : sprays_) cell_m = std::max(cell_m, spray.radius_m);
    for (const Plant& plant : plants_) {
      stems.push_back(plant.p_F_m);
      ids.push_back(plant.id);
    }
    const PointGrid<Eigen::Vector2d> grid(stems, cell_m);
    association_ = associate(ids, grid, tracks_, parameters_.association_radius_m);
    index_decisions();
    apply_sprays(grid);
    for (std::size_t i = 0; i < plants_.size(); ++i) ledger_.rows.push_back(row(i));
    summarise();
    return std::move(ledger_);
  }

 private:
  void index_decisions() {
    decision_of_track_.assign(tracks_.size(), kNoIndex);
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      if (const auto all = decisions_of(tracks_[t].id); !all.empty()) {
        decision_of_track_[t] = static_cast<std::size_t>(&all.back() - decisions_.data());
      }
      track_of_id_.emplace(tracks_[t].id, t);
    }
  }

  /// All decisions about a track, in the order of time.
  [[nodiscard]] std::span<const Decision> decisions_of(std::int64_t track_id) const {
    const auto found = std::ranges::equal_range(decisions_, track_id, {}, &Decision::track_id);
    return {found.begin(), found.end()};
  }

  static void keep_nearest(std::size_t& best, double& best_m, std::size_t spray,
                           double distance_m) {
    if (best != kNoIndex && best_m <= distance_m) return;
    best = spray;
    best_m = distance_m;
  }

  /// Of the tracks that a spray names, the one nearest to a plant that it stands for. The order of
  /// the names has no meaning. @pre the spray names one.
  [[nodiscard]] std::size_t nearest_named(const Spray& spray, std::size_t plant) const {
    const auto distance_m = [&](std::size_t track) {
      return (tracks_[track].p_F_m - plants_[plant].p_F_m).norm();
    };
    std::size_t nearest = kNoIndex;
    for (const std::int64_t id : spray.track_ids) {
      const auto track = track_of_id_.find(id);
      if (track == track_of_id_.end() || association_.plant_of_track[track->second] != plant) {
        continue;
      }
      const std::size_t t = track->second;
      if (nearest == kNoIndex ||
          std::pair(distance_m(t), t) < std::pair(distance_m(nearest), nearest)) {
        nearest = t;
      }
    }
    return nearest;
  }

  void apply_sprays(const PointGrid<Eigen::Vector2d>& grid) {
    sprayed_.resize(plants_.size());
    for (std::size_t s = 0; s < sprays_.size(); ++s) {
      const Spray& spray = sprays_[s];
      bool took_weed = false;
      const double reach_m = std::max(spray.radius_m, parameters_.partial_radius_m);
      grid.for_each_within(spray.p_F_m, reach_m, [&](std::size_t plant, double distance_m) {
        const bool weed = plants_[plant].kind == PlantKind::kWeed;
        if (distance_m > (weed ? parameters_.partial_radius_m : spray.radius_m)) return;
        took_weed = took_weed || weed;
        keep_nearest(sprayed_[plant].landed, sprayed_[plant].landed_m, s, distance_m);
      });
      if (!took_weed) ++ledger_.summary.sprays_without_weed;

      // How far the spray lies from the stem, but for what it was meant to lie beside the track.
      const auto aim_at = [&](std::size_t plant, const Eigen::Vector2d& meant_F_m) {
        Sprayed& sprayed = sprayed_[plant];
        const Eigen::Vector2d offset_F_m = spray.p_F_m - plants_[plant].p_F_m;
        keep_nearest(sprayed.aimed, sprayed.aimed_m, s, offset_F_m.norm());
        if (sprayed.aimed == s) sprayed.error_m = (offset_F_m - meant_F_m).norm();
      };
      for (const std::int64_t id : spray.track_ids) {
        const auto track = track_of_id_.find(id);
        if (track == track_of_id_.end()) continue;
        const std::size_t plant = association_.plant_of_track[track->second];
        if (plant == kNoIndex) continue;
        aim_at(plant, spray.aim_F_m - tracks_[nearest_named(spray, plant)].p_F_m);
      }
      if (spray.track_ids.empty() && spray.commanded) {
        grid.for_each_within(
            spray.aim_F_m, parameters_.partial_radius_m,
            [&](std::size_t plant, double) { aim_at(plant, Eigen::Vector2d::Zero()); });
      }
    }
  }

  /// The last word on a plant: on its own track, or else the latest on a duplicate.
  [[nodiscard]] const Decision* decision_on(std::size_t plant) const {
    const std::size_t track = association_.track_of_plant[plant];
    if (track == kNoIndex) return nullptr;
    if (decision_of_track_[track] != kNoIndex) return &decisions_[decision_of_track_[track]];
    const Decision* latest = nullptr;
    for (const std::size_t duplicate : association_.duplicates[plant]) {
      const std::size_t d = decision_of_track_[duplicate];
      if (d == kNoIndex) continue;
      if (latest == nullptr || decisions_[d].time > latest->time) latest = &decisions_[d];
    }
    return latest;
  }

  /// The latest decision about a track at or before a time; with `action`, the latest such.
  [[nodiscard]] const Decision* decision_before(std::int64_t track_id, Time time,
                                                std::optional<Action> action) const {
    const Decision* latest = nullptr;
    for (const Decision& decision : decisions_of(track_id)) {
      if (decision.time > time) break;
      if (!action || decision.action == *action) latest = &decision;
    }
    return latest;
  }

  /// The decision behind a spray that reached a plant or was aimed at it. Of a track that the spray
  /// names it is the last one to treat. Later decisions did not lead to the outcome, such as that
  /// the robot has passed the track.
  [[nodiscard]] const Decision* decision_behind(const Spray& spray, std::size_t plant) const {
    const Decision* latest = nullptr;
    for (const std::int64_t id : spray.track_ids) {
      const auto track = track_of_id_.find(id);
      if (track == track_of_id_.end()) continue;
      if (association_.plant_of_track[track->second] != plant) continue;
      const Decision* treat = decision_before(id, spray.time, Action::kTreat);
      if (treat != nullptr && (latest == nullptr || treat->time > latest->time)) latest = treat;
    }
    if (latest != nullptr) return latest;
    const std::size_t own = association_.track_of_plant[plant];
    return own == kNoIndex ? nullptr : decision_before(tracks_[own].id, spray.time, std::nullopt);
  }

  [[nodiscard]] Reason cause(std::size_t plant, const Decision* decision) const {
    const Eigen::Vector2d& p_F = plants_[plant].p_F_m;
    const auto beyond = [](const std::optional<std::pair<double, double>>& span, double v) {
      return span && (v < span->first || v > span->second);
    };
    if (sprayed_[plant].aimed != kNoIndex) return Reason::kPlacement;
    if (beyond(info_.reach_y_m, p_F.y())) return Reason::kOutside;
    if (beyond(info_.passed_x_m, p_F.x())) return Reason::kEndOfRun;
    const std::size_t track = association_.track_of_plant[plant];
    if (track == kNoIndex) return Reason::kUndetected;
    if (!tracks_[track].confirmed) return Reason::kUnconfirmed;
    if (tracks_[track].kind == PlantKind::kCrop) return Reason::kMisclassified;
    if (decision == nullptr || decision->action == Action::kNone) return Reason::kUnreachable;
    if (decision->action == Action::kTreat) return Reason::kFault;
    return decision->reason;
  }

  [[nodiscard]] LedgerRow row(std::size_t i) const {
    const Plant& plant = plants_[i];
    LedgerRow row{.plant_id = plant.id,
                  .kind = plant.kind,
                  .species = plant.species,
                  .p_F_m = plant.p_F_m,
                  .radius_m = plant.radius_m,
                  .area_mm2 = plant.area_mm2};
    const Decision* decision = decision_on(i);
    const Sprayed& sprayed = sprayed_[i];
    const bool landed = sprayed.landed != kNoIndex;
    const std::size_t by = landed ? sprayed.landed : sprayed.aimed;
    const Decision* led = by == kNoIndex ? decision : decision_behind(sprays_[by], i);
    if (led != nullptr) {
      row.action = led->action;
      if (led->action == Action::kTreat) row.axis = led->axis;
    }
    if (plant.kind == PlantKind::kCrop) {
      row.outcome = landed ? Outcome::kHit : Outcome::kSpared;
    } else if (landed) {
      row.outcome = sprayed.landed_m <= parameters_.accurate_radius_m ? Outcome::kAccurate
                                                                      : Outcome::kPartial;
    } else {
      row.reason = cause(i, decision);
    }
    if (by != kNoIndex) {
      const Spray& spray = sprays_[by];
      row.axis = spray.axis;
      row.sprayed = spray.time;
      row.spray_distance_m = landed ? sprayed.landed_m : sprayed.aimed_m;
    }
    if (const std::size_t track = association_.track_of_plant[i]; track != kNoIndex) {
      row.track_id = tracks_[track].id;
      row.track_kind = tracks_[track].kind;
      row.track_distance_m = association_.distance_m[i];
    }
    set_seen(i, led, row);
    return row;
  }

  /// What the robot took the plant for: of the decision that led to the outcome, or where that one
  /// has no appraisal, of the latest that has one.
  void set_seen(std::size_t plant, const Decision* led, LedgerRow& row) const {
    const std::size_t track = association_.track_of_plant[plant];
    if (track == kNoIndex) return;
    if (led != nullptr) row.appraisal = led->appraisal;
    if (!row.appraisal) {
      for (const Decision& decision : decisions_of(tracks_[track].id)) {
        if (decision.appraisal) row.appraisal = decision.appraisal;
      }
    }
    const TrackView& view = tracks_[track];
    row.seen_species = row.appraisal ? row.appraisal->species : view.species;
    const double probability =
        row.appraisal ? row.appraisal->species_probability : view.species_probability;
    if (!row.seen_species.empty()) row.seen_probability = probability;
  }

  void summarise() {
    Summary& summary = ledger_.summary;
    take_run_info(info_, summary);
    count_rows(ledger_.rows, summary);
    summary.sprays = static_cast<std::int64_t>(sprays_.size());
    summary.sprays_by_axis.assign(info_.axis_travel_m.size(), 0);
    std::vector<double> aim_mm;
    for (const Spray& spray : sprays_) {
      const auto axis = static_cast<std::size_t>(spray.axis);
      if (axis >= summary.sprays_by_axis.size()) summary.sprays_by_axis.resize(axis + 1, 0);
      ++summary.sprays_by_axis[axis];
      if (spray.commanded) {
        aim_mm.push_back((spray.p_F_m - spray.aim_F_m).norm() * 1e3);
      } else {
        ++summary.sprays_uncommanded;
      }
    }
    for (std::size_t i = 0; i < plants_.size(); ++i) {
      const Sprayed& sprayed = sprayed_[i];
      if (plants_[i].kind != PlantKind::kWeed || sprayed.aimed == kNoIndex) continue;
      ledger_.placement_errors_mm.push_back(sprayed.error_m * 1e3);
    }
    std::sort(aim_mm.begin(), aim_mm.end());
    std::sort(ledger_.placement_errors_mm.begin(), ledger_.placement_errors_mm.end());
    set_errors(ledger_.placement_errors_mm, aim_mm, summary);
    summary.tracks_total = static_cast<std::int64_t>(tracks_.size());
    summary.tracks_without_plant = association_.tracks_without_plant;
  }

  const AccountParameters& parameters_;
  const RunInfo& info_;
  std::vector<Plant> plants_;
  std::vector<TrackView> tracks_;
  std::vector<Decision> decisions_;
  std::vector<Spray> sprays_;
  Association association_;
  std::vector<std::size_t> decision_of_track_;
  std::unordered_map<std::int64_t, std::size_t> track_of_id_;
  std::vector<Sprayed> sprayed_;
  Ledger ledger_;
};

}  // namespace

Result<Ledger> account(const field::FieldModel& truth, const RunRecord& record,
                       const AccountParameters& parameters) {
  if (const Status valid = validate(truth, record, parameters); !valid) return valid.error();
  return Accountant(truth, record, parameters).run();
}

Result<Ledger> account_tracks(const field::FieldModel& strip, const RunRecord& record,
                              const AccountParameters& parameters) {
  field::FieldModel seen{.name = strip.name,
                         .source = strip.source,
                         .length_m = strip.length_m,
                         .width_m = strip.width_m,
                         .row_y_m = strip.row_y_m,
                         .plants = {}};
  for (const TrackView& track : record.tracks) {
    if (!track.confirmed) continue;
    field::Plant plant;
    plant.id = track.id;
    plant.kind = track.kind;
    plant.species = track.species;
    plant.p_F_m = track.p_F_m;
    plant.radius_m = track.radius_m;
    plant.area_mm2 = track.area_mm2;
    seen.plants.push_back(std::move(plant));
  }
  Result<Ledger> ledger = account(seen, record, parameters);
  if (!ledger) return ledger;
  // How far a spray landed from a stem, only ground truth tells; the tracks are where it was aimed.
  ledger->placement_errors_mm.clear();
  Summary& summary = ledger->summary;
  summary.against_truth = false;
  summary.placement_error_p50_mm.reset();
  summary.placement_error_p95_mm.reset();
  summary.placement_error_deciles_mm.clear();
  return ledger;
}

}  // namespace furrow::ledger
