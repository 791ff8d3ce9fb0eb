#include "joint_planner.hpp"

#include <algorithm>

namespace furrow::planning {
Status JointPlanner::plan(const PlanningProblem& problem, Plan& plan) {
  if (Status status = prepare(problem, parameters_, 0.0, prepared_, plan); !status) {
    return status;
  }
  drop_protected(problem, parameters_, prepared_, plan);
  group_axes(prepared_, classes_);
  chains_.resize(prepared_.starts.size());
  for (auto& chain : chains_) {
    chain.clear();
  }
  if (classes_.size() <= 1) {
    solve_classes();
    write_chains(problem, prepared_, chains_, plan);
    plan.weight_bound = problem.speeds == nullptr ? plan.weight : weight_of_nodes();
    return {};
  }
  const auto bound = static_cast<double>(solve_mixed(problem));
  write_chains(problem, prepared_, chains_, plan);
  // Scores are rounded to the nearest one.
  plan.weight_bound =
      problem.speeds != nullptr
          ? weight_of_nodes()
          : std::max(plan.weight, (bound + 0.5 * static_cast<double>(prepared_.nodes.size())) /
                                      prepared_.scoring.scores_per_weight);
  return {};
}

/// At speeds that change, what the axes may do is told by the greatest one, and the flow is no
/// optimum.
double JointPlanner::weight_of_nodes() const {
  double weight = 0.0;
  for (const Node& node : prepared_.nodes) weight += node.weight;
  return weight;
}

std::int64_t JointPlanner::solve_mixed(const PlanningProblem& problem) {
  const std::int64_t from_nothing = solve_classes();
  kept_ = chains_;
  const std::int64_t bound = solve_relaxed(problem);
  for (std::size_t a = 0; a < chains_.size(); ++a) {
    chains_[a].clear();
    if (prepared_.starts[a].usable) {
      solver_.solve(prepared_, prepared_.starts[a], candidate_[a], chains_[a]);
    }
  }
  if (solve_classes() < from_nothing) {
    chains_.swap(kept_);
  }
  return bound;
}

std::int64_t JointPlanner::solve_classes() {
  taken_.assign(prepared_.nodes.size(), 0);
  candidate_.resize(chains_.size());
  std::int64_t total = 0;
  for (const auto& chain : chains_) {
    for (const std::uint32_t k : chain) {
      taken_[k] = 1;
      total += prepared_.nodes[k].score;
    }
  }
  const int rounds = classes_.size() > 1 ? kRounds : 1;
  for (int round = 0; round < rounds; ++round) {
    bool gained = false;
    for (const auto& axes : classes_) {
      std::int64_t before = 0;
      for (const std::uint32_t a : axes) {
        for (const std::uint32_t k : chains_[a]) {
          taken_[k] = 0;
          before += prepared_.nodes[k].score;
        }
      }
      members_.clear();
      for (std::uint32_t k = 0; k < prepared_.nodes.size(); ++k) {
        if (taken_[k] == 0 && prepared_.starts[axes.front()].spans(prepared_.nodes[k].y_m)) {
          members_.push_back(k);
        }
      }
      const std::int64_t after = flow_.solve(prepared_, members_, axes, candidate_);
      if (after > before) {
        gained = true;
        total += after - before;
        for (const std::uint32_t a : axes) {
          chains_[a].assign(candidate_[a].begin(), candidate_[a].end());
        }
      }
      for (const std::uint32_t a : axes) {
        for (const std::uint32_t k : chains_[a]) {
          taken_[k] = 1;
        }
      }
    }
    if (!gained) {
      break;
    }
  }
  return total;
}

std::int64_t JointPlanner::solve_relaxed(const PlanningProblem& problem) {
  AxisSpec widest = problem.axes[classes_.front().front()];
  for (const auto& axes : classes_) {
    const AxisSpec& axis = problem.axes[axes.front()];
    widest.lower_m = std::min(widest.lower_m, axis.lower_m);
    widest.upper_m = std::max(widest.upper_m, axis.upper_m);
    widest.max_velocity_mps = std::max(widest.max_velocity_mps, axis.max_velocity_mps);
    widest.max_acceleration_mps2 =
        std::max(widest.max_acceleration_mps2, axis.max_acceleration_mps2);
  }
  relaxed_.nodes.assign(prepared_.nodes.begin(), prepared_.nodes.end());
  relaxed_.starts.assign(prepared_.starts.begin(), prepared_.starts.end());
  relaxed_.scoring = prepared_.scoring;
  const Transition quickest(parameters_, prepared_.speed_mps, widest);
  members_.clear();
  for (const auto& axes : classes_) {
    members_.insert(members_.end(), axes.begin(), axes.end());
  }
  for (Start& start : relaxed_.starts) {
    start.lower_y_m = prepared_.robot_y_m + widest.lower_m;
    start.upper_y_m = prepared_.robot_y_m + widest.upper_m;
    start.transition = quickest;
  }
  std::vector<std::uint32_t> all(relaxed_.nodes.size());
  for (std::uint32_t k = 0; k < all.size(); ++k) {
    all[k] = k;
  }
  return flow_.solve(relaxed_, all, members_, candidate_);
}

}  // namespace furrow::planning
