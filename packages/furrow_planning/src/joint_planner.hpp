#pragma once

#include <cstdint>
#include <vector>

#include "chain_solver.hpp"
#include "furrow_planning/route_planner.hpp"
#include "joint_flow.hpp"

namespace furrow::planning {

/// Plans all axes together. Exact when the axes in service agree in span and limits (offsets and
/// states may differ).
///
/// Axes that differ are planned class by class, each class exactly on the targets that the others
/// leave, in rounds until nothing is gained. Plan::weight_bound then comes from axes with the
/// widest span and the fastest limits of all, and bounds the gap. The rounds start once from the
/// routes of that bound, cut to the limits of each axis, and once from empty routes; the better
/// result wins.
class JointPlanner final : public RoutePlanner {
 public:
  explicit JointPlanner(const PlannerParameters& parameters) : parameters_(parameters) {}
  [[nodiscard]] Status plan(const PlanningProblem& problem, Plan& plan) override;
  [[nodiscard]] std::string_view name() const override { return "exact joint"; }

 private:
  static constexpr int kRounds = 8;
  /// Improves chains_ class by class until nothing is gained. Returns their score.
  std::int64_t solve_classes();
  /// Writes chains_; returns the bound.
  [[nodiscard]] double weight_of_nodes() const;
  [[nodiscard]] std::int64_t solve_mixed(const PlanningProblem& problem);
  [[nodiscard]] std::int64_t solve_relaxed(const PlanningProblem& problem);

  PlannerParameters parameters_;
  PreparedProblem prepared_;
  PreparedProblem relaxed_;
  JointFlow flow_;
  ChainSolver solver_;
  std::vector<std::vector<std::uint32_t>> classes_;  ///< axes in service that agree
  std::vector<std::vector<std::uint32_t>> chains_;
  std::vector<std::vector<std::uint32_t>> candidate_;
  std::vector<std::vector<std::uint32_t>> kept_;
  std::vector<std::uint32_t> members_;
  std::vector<char> taken_;
};

}  // namespace furrow::planning
