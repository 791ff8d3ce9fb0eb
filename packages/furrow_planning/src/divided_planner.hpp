#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "assignment.hpp"
#include "axis_routes.hpp"
#include "furrow_planning/route_planner.hpp"

namespace furrow::planning {

/// Divides the targets among the axes, then plans each axis on its own, on several threads if
/// asked.
class DividedPlanner final : public RoutePlanner {
 public:
  explicit DividedPlanner(const PlannerParameters& parameters);
  [[nodiscard]] Status plan(const PlanningProblem& problem, Plan& plan) override;
  [[nodiscard]] std::string_view name() const override { return name_; }

 private:
  void route_axes();

  PlannerParameters parameters_;
  std::string name_;
  Assignment assignment_;
  PreparedProblem prepared_;
  std::vector<std::unique_ptr<AxisRouter>> routers_;
  std::vector<std::vector<std::uint32_t>> members_;
  std::vector<std::vector<std::uint32_t>> chains_;
};

/// In the order of x each target to the axis, of those that can reach it, with the least travel.
class JointGreedyPlanner final : public RoutePlanner {
 public:
  explicit JointGreedyPlanner(const PlannerParameters& parameters) : parameters_(parameters) {}
  [[nodiscard]] Status plan(const PlanningProblem& problem, Plan& plan) override;
  [[nodiscard]] std::string_view name() const override { return "joint greedy"; }

 private:
  PlannerParameters parameters_;
  PreparedProblem prepared_;
  std::vector<Start> heads_;
  std::vector<std::vector<std::uint32_t>> chains_;
};

}  // namespace furrow::planning
