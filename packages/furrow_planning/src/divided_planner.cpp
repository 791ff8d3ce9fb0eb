#include "divided_planner.hpp"

#include <cmath>
#include <limits>

#include "furrow_core/error.hpp"
#include "furrow_core/parallel.hpp"

namespace furrow::planning {
namespace {

std::unique_ptr<AxisRouter> make_router(const PlannerParameters& parameters) {
  if (parameters.planner == "greedy") {
    return make_greedy_router();
  }
  if (parameters.planner == "notsp") {
    return make_notsp_router(static_cast<std::size_t>(parameters.notsp_targets));
  }
  if (parameters.planner == "permutation") {
    return make_permutation_router(static_cast<std::size_t>(parameters.permutation_targets),
                                   parameters.omega);
  }
  return make_exact_router();
}

Assignment parse_assignment(const std::string& name) {
  if (name == "distance") {
    return Assignment::kDistance;
  }
  return name == "dynamic" ? Assignment::kDynamic : Assignment::kStatic;
}

void bound_by_all(const PreparedProblem& prepared, Plan& plan) {
  for (const Node& node : prepared.nodes) {
    plan.weight_bound += node.weight;
  }
}

}  // namespace

DividedPlanner::DividedPlanner(const PlannerParameters& parameters)
    : parameters_(parameters),
      name_(parameters.planner + " " + parameters.assignment),
      assignment_(parse_assignment(parameters.assignment)) {}

Status DividedPlanner::plan(const PlanningProblem& problem, Plan& plan) {
  if (Status status = prepare(problem, parameters_, 0.0, prepared_, plan); !status) {
    return status;
  }
  drop_protected(problem, parameters_, prepared_, plan);
  assign(assignment_, prepared_, members_);
  while (routers_.size() < members_.size()) {
    routers_.push_back(make_router(parameters_));
  }
  chains_.resize(members_.size());
  route_axes();
  write_chains(problem, prepared_, chains_, plan);
  bound_by_all(prepared_, plan);
  return {};
}

void DividedPlanner::route_axes() {
  // Each axis has its own router and chain: the threads share nothing that they write.
  parallel_for(members_.size(), static_cast<std::size_t>(parameters_.threads),
               [this](std::size_t a) {
                 routers_[a]->route(prepared_, prepared_.starts[a], members_[a], chains_[a]);
               });
}

Status JointGreedyPlanner::plan(const PlanningProblem& problem, Plan& plan) {
  if (Status status = prepare(problem, parameters_, 0.0, prepared_, plan); !status) {
    return status;
  }
  drop_protected(problem, parameters_, prepared_, plan);
  heads_.assign(prepared_.starts.begin(), prepared_.starts.end());
  chains_.resize(heads_.size());
  for (auto& chain : chains_) {
    chain.clear();
  }
  for (std::uint32_t k = 0; k < prepared_.nodes.size(); ++k) {
    const Node& node = prepared_.nodes[k];
    double least_m = std::numeric_limits<double>::infinity();
    std::size_t axis = heads_.size();
    for (std::size_t a = 0; a < heads_.size(); ++a) {
      const Start& head = heads_[a];
      const double travel_m = std::abs(node.y_m - head.y_m);
      if (head.usable && head.spans(node.y_m) && travel_m < least_m &&
          head.reaches(node.x_m, node.y_m)) {
        least_m = travel_m;
        axis = a;
      }
    }
    if (axis < heads_.size()) {
      chains_[axis].push_back(k);
      heads_[axis].x_m = node.x_m;
      heads_[axis].y_m = node.y_m;
      heads_[axis].after_spray = true;
    }
  }
  write_chains(problem, prepared_, chains_, plan);
  bound_by_all(prepared_, plan);
  return {};
}

}  // namespace furrow::planning
