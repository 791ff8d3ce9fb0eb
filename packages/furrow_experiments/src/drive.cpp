#include "furrow_experiments/drive.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <tuple>

#include "furrow_experiments/audit.hpp"

namespace furrow::experiments {
namespace {

using planning::TargetOutcome;

struct Reach {
  double front_m = 0.0;
  double rear_m = 0.0;
};

Reach reach_of(const std::vector<planning::AxisSpec>& axes) {
  Reach reach{axes.front().offset_x_m, axes.front().offset_x_m};
  for (const planning::AxisSpec& axis : axes) {
    reach.front_m = std::max(reach.front_m, axis.offset_x_m);
    reach.rear_m = std::min(reach.rear_m, axis.offset_x_m);
  }
  return reach;
}

/// Outcomes of one spray have its axis and centre in common.
std::vector<Spray> sprays_of(const std::vector<TargetOutcome>& outcomes) {
  std::vector<const TargetOutcome*> treated;
  for (const TargetOutcome& outcome : outcomes) {
    if (outcome.decision == planning::Decision::kTreat) treated.push_back(&outcome);
  }
  const auto key = [](const TargetOutcome* outcome) {
    return std::tuple(outcome->axis, outcome->aim_F.x(), outcome->aim_F.y());
  };
  std::stable_sort(treated.begin(), treated.end(),
                   [&](const auto* a, const auto* b) { return key(a) < key(b); });
  std::vector<Spray> sprays;
  const TargetOutcome* last = nullptr;
  for (const TargetOutcome* outcome : treated) {
    if (last == nullptr || key(last) != key(outcome)) {
      sprays.push_back({static_cast<std::size_t>(outcome->axis), outcome->aim_F, {}});
    }
    sprays.back().treated.push_back(outcome->id);
    last = outcome;
  }
  return sprays;
}

/// Gives the view what it sees first at this frame.
class Observer {
 public:
  explicit Observer(const FieldTargets& field) : field_(field) {}

  Status show(planning::ObservationView& view, double until_x_m) {
    for (; weed_ < field_.weeds.size() && field_.weeds[weed_].p_F.x() < until_x_m; ++weed_) {
      if (Status status = view.update(field_.weeds[weed_]); !status.ok()) return status;
    }
    for (; crop_ < field_.crops.size() && field_.crops[crop_].p_F.x() < until_x_m; ++crop_) {
      if (Status status = view.update_protected(field_.crops[crop_]); !status.ok()) return status;
    }
    return {};
  }

 private:
  const FieldTargets& field_;
  std::size_t weed_ = 0;
  std::size_t crop_ = 0;
};

}  // namespace

double start_x_m(const SetupParameters& setup) {
  return -setup.look_ahead_m - reach_of(axis_specs(setup)).front_m;
}

Result<DriveResult> drive(const FieldTargets& field, const planning::PlannerParameters& planner,
                          const SetupParameters& setup, const AllocationCount& allocations) {
  using Clock = std::chrono::steady_clock;
  constexpr double kRounding_m = 1e-9;
  const auto axes = axis_specs(setup);
  const Reach reach = reach_of(axes);
  const auto view = planning::make_observation_view(planner, axes);
  const double step_m = setup.frame_period_s * planner.speed_mps;
  const double start_m = start_x_m(setup);
  const double way_m = field.length_m + planner.footprint_radius_m - reach.rear_m - start_m;
  const auto frames = static_cast<std::int64_t>(std::ceil(way_m / step_m)) + 2;

  DriveResult result;
  Observer observer(field);
  for (std::int64_t frame = 0; frame < frames; ++frame) {
    const double x_m = start_m + step_m * static_cast<double>(frame);
    const double seen_m = x_m + reach.front_m + setup.look_ahead_m + kRounding_m;
    const planning::RobotState robot{.x_m = x_m, .speed_mps = planner.speed_mps};
    if (Status status = view->advance(robot, seen_m); !status.ok()) return status.error();
    if (Status status = observer.show(*view, seen_m); !status.ok()) return status.error();
    const std::uint64_t allocated = allocations ? allocations() : 0;
    const auto begin = Clock::now();
    const auto replanned = view->replan();
    const std::chrono::duration<double, std::micro> time = Clock::now() - begin;
    if (!replanned.ok()) return replanned.error();
    if (!*replanned) continue;
    if (allocations) result.replan_allocations.push_back(allocations() - allocated);
    result.replan_us.push_back(time.count());
  }
  view->take_outcomes(result.outcomes);
  if (result.outcomes.size() != field.weeds.size()) {
    return Error{ErrorCode::kNoSolution, std::to_string(result.outcomes.size()) +
                                             " outcomes were reported for " +
                                             std::to_string(field.weeds.size()) + " weeds"};
  }
  std::sort(result.outcomes.begin(), result.outcomes.end(),
            [](const auto& a, const auto& b) { return a.id < b.id; });
  result.travel_m = view->travel_m();
  result.sprays = sprays_of(result.outcomes);
  if (Status sound = check_sprays(field, result.sprays, planner, setup); !sound.ok()) {
    return sound.error();
  }
  return result;
}

}  // namespace furrow::experiments
