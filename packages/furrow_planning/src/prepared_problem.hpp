#pragma once

#include <cstdint>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_planning/kinematics.hpp"
#include "furrow_planning/parameters.hpp"
#include "furrow_planning/speed_profile.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::planning {

/// A target that can be planned for.
struct Node {
  double x_m = 0.0;  ///< in F, as y_m
  double y_m = 0.0;
  double weight = 0.0;
  std::int64_t score = 0;    ///< weight in whole quanta, see Scoring
  std::uint32_t target = 0;  ///< into PlanningProblem::targets
};

/// An axis in the terms of the field: the point on the ground that its nozzle's line crosses when
/// it is next free, and where its nozzle may spray.
struct Start {
  double x_m = 0.0;
  double y_m = 0.0;
  double lower_y_m = 0.0;
  double upper_y_m = 0.0;
  double offset_x_m = 0.0;
  bool usable = false;
  bool after_spray = false;
  Transition transition;  ///< for the greatest of the robot's speeds
  const SpeedProfile* speeds = nullptr;

  /// The place x of the ground as the axis meets it, on a scale on which the robot goes at the
  /// transition's speed: only differences count.
  [[nodiscard]] double way_m(double x) const {
    return speeds == nullptr ? x : transition.speed_mps() * speeds->time_s(x - offset_x_m);
  }
  /// Whether a spray at the second place can follow one at the first.
  [[nodiscard]] bool follows(double from_x, double from_y, double to_x, double to_y) const {
    return transition.feasible(way_m(to_x) - way_m(from_x), to_y - from_y);
  }
  [[nodiscard]] bool spans(double y) const { return y >= lower_y_m && y <= upper_y_m; }
  [[nodiscard]] double needed_dx_m(double dy_m) const {
    return after_spray ? transition.needed_dx_m(dy_m) : transition.first_dx_m(dy_m);
  }
  [[nodiscard]] bool reaches(double x, double y) const {
    return way_m(x) - way_m(x_m) >= needed_dx_m(y - y_m) - Transition::kSlack_m;
  }
};

/// Weights and travel as whole numbers, so that comparisons are exact, the same everywhere, and
/// free of rounding in shortest paths: one score of weight outweighs any sum of travel.
struct Scoring {
  static constexpr std::int64_t kWeightLevels = std::int64_t{1} << 20;  ///< of the greatest weight
  static constexpr std::int64_t kTravelLevels = std::int64_t{1} << 10;  ///< of the greatest move
  static constexpr int kTravelBits = 26;
  static constexpr std::int64_t kScore = std::int64_t{1} << kTravelBits;

  double scores_per_weight = 0.0;
  double levels_per_m = 0.0;

  [[nodiscard]] std::int64_t travel(double dy_m) const {
    return static_cast<std::int64_t>((dy_m < 0.0 ? -dy_m : dy_m) * levels_per_m);
  }
};

/// The checked problem, its targets in the order of x (then y, then as given).
struct PreparedProblem {
  std::vector<Node> nodes;
  std::vector<Start> starts;  ///< one for each axis
  Scoring scoring;
  double speed_mps = 0.5;  ///< the greatest, where it changes
  double robot_y_m = 0.0;
  std::vector<std::uint32_t> order;  ///< scratch
};

/// The radius within which a stem counts as treated.
[[nodiscard]] double treat_radius_m(const PlannerParameters& parameters);

/// The least distance between a spray's centre and a protected stem.
[[nodiscard]] double keep_out_m(const PlannerParameters& parameters, const ProtectedPlant& plant);

/// Checks and sorts. Writes a decision for each target into `plan`: kUnreachable for those that
/// stay in the problem. A target up to `aim_reach_m` outside an axis's span counts as inside.
[[nodiscard]] Status prepare(const PlanningProblem& problem, const PlannerParameters& parameters,
                             double aim_reach_m, PreparedProblem& prepared, Plan& plan);

/// Takes out the targets whose own stem no spray may be centred on.
void drop_protected(const PlanningProblem& problem, const PlannerParameters& parameters,
                    PreparedProblem& prepared, Plan& plan);

/// Writes chains of nodes (one for each axis, in order) as routes of sprays on their stems.
void write_chains(const PlanningProblem& problem, const PreparedProblem& prepared,
                  const std::vector<std::vector<std::uint32_t>>& chains, Plan& plan);

/// Fills position, robot_x and depart_x of a stop that follows `previous` (null: the first one).
void time_stop(const Start& start, double robot_y_m, const Stop* previous, Stop& stop);

}  // namespace furrow::planning
