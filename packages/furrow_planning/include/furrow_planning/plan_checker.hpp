#pragma once

#include "furrow_core/result.hpp"
#include "furrow_planning/parameters.hpp"
#include "furrow_planning/types.hpp"

namespace furrow::planning {

/// Checks a plan against its problem, from the definitions alone; shares no code with the planners.
/// Time O(n log n), cheap enough for every plan. The error names the axis, stop or target.
///
/// - Route: order along the travel, axis in service and within its span, first stop reachable from
///   the axis's state, Gamma >= rho between consecutive stops.
/// - Stop: aim agrees with axis and robot; no protection zone is entered.
/// - Target: treated at most once, within the footprint of its stop, by its decision.
/// - Plan: one decision for each target; sums of weight and travel.
class PlanChecker {
 public:
  explicit PlanChecker(const PlannerParameters& parameters) : parameters_(parameters) {}
  [[nodiscard]] Status check(const PlanningProblem& problem, const Plan& plan);

 private:
  struct Seen {
    TargetId id = 0;
    std::uint32_t index = 0;
    bool treated = false;
  };
  /// State of an axis between two stops, and the sums so far.
  struct Walk {
    double from_x_m = 0.0;
    double from_position_m = 0.0;
    double dwell_s = 0.0;
    bool sprayed = false;  ///< before `from_x_m`
  };

  [[nodiscard]] Status check_shape(const PlanningProblem& problem, const Plan& plan);
  void sort_crops(const PlanningProblem& problem);
  [[nodiscard]] Status check_route(const PlanningProblem& problem, const Plan& plan, std::size_t a);
  [[nodiscard]] Status check_aim(const PlanningProblem& problem, std::size_t a, std::size_t s,
                                 const Stop& stop) const;
  [[nodiscard]] Status check_timing(const PlanningProblem& problem, const Plan& plan, std::size_t a,
                                    std::size_t s, const Walk& walk) const;
  [[nodiscard]] Status check_crops(const PlanningProblem& problem, std::size_t a, std::size_t s,
                                   const Stop& stop) const;
  [[nodiscard]] Status check_targets(const PlanningProblem& problem, const Plan& plan,
                                     std::size_t a, std::size_t s);
  [[nodiscard]] Status check_sums(const Plan& plan) const;

  PlannerParameters parameters_;
  std::vector<Seen> seen_;  ///< by id; the first given of equal ids first
  std::vector<std::uint32_t> crops_by_x_;
  double widest_zone_m_ = 0.0;  ///< of a protected plant, with the footprint
  double speed_mps_ = 0.0;      ///< the greatest of the robot
  double weight_ = 0.0;         ///< sums over the stops checked so far
  double travel_m_ = 0.0;
  std::size_t treated_ = 0;
};

}  // namespace furrow::planning
