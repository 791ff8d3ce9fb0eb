#include "footprint_planner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "passing_fire.hpp"

namespace furrow::planning {
namespace {

constexpr double kSaturated = 0.05;     ///< share left from which on the axes have no time to spare
constexpr std::int64_t kFruitless = 3;  ///< rounds without gain that then end the pursuit

}  // namespace

Status FootprintPlanner::plan(const PlanningProblem& problem, Plan& plan) {
  if (Status status = prepare(problem, parameters_, treat_radius_m(parameters_), prepared_, plan);
      !status) {
    return status;
  }
  candidates_.build(problem, parameters_, prepared_, -std::numeric_limits<double>::infinity(), {});
  chains_.resize(prepared_.starts.size());
  for (auto& chain : chains_) {
    chain.clear();
  }
  covered_.assign(prepared_.nodes.size(), 0);
  extra_.assign(prepared_.nodes.size(), 0);
  start_from_stems();
  improve_routes(parameters_.improvement_rounds + 1);
  best_value_ = weigh_all();
  best_chains_ = chains_;
  const bool saturated =
      kSaturated * static_cast<double>(prepared_.nodes.size()) < static_cast<double>(count_left());
  if (saturated) {
    search_again();
  }
  pursue_left(saturated ? kFruitless : parameters_.improvement_rounds);
  chains_.swap(best_chains_);
  write_routes(problem, plan);
  return {};
}

void FootprintPlanner::start_from_stems() {
  const auto& sprays = candidates_.sprays();
  group_axes(prepared_, classes_);
  for (const auto& axes : classes_) {
    members_.clear();
    for (std::uint32_t k = 0; k < prepared_.nodes.size(); ++k) {
      const Node& node = prepared_.nodes[k];
      if (covered_[k] == 0 && prepared_.starts[axes.front()].spans(node.y_m) &&
          candidates_.allowed(node.x_m, node.y_m)) {
        members_.push_back(k);
      }
    }
    flow_.solve(prepared_, members_, axes, chains_);
    for (const std::uint32_t a : axes) {
      // From nodes to the sprays that are centred on them.
      for (std::uint32_t& k : chains_[a]) {
        const Node& node = prepared_.nodes[k];
        const auto on_stem = std::lower_bound(
            sprays.begin(), sprays.end(), node, [](const Spray& spray, const Node& value) {
              return spray.x_m != value.x_m ? spray.x_m < value.x_m : spray.y_m < value.y_m;
            });
        k = static_cast<std::uint32_t>(on_stem - sprays.begin());
      }
      cover(chains_[a], 1);
    }
  }
}

void FootprintPlanner::cover(const std::vector<std::uint32_t>& chain, int change) {
  for (const std::uint32_t s : chain) {
    for (const Cover& cover : candidates_.covers(candidates_.sprays()[s])) {
      covered_[cover.node] = static_cast<std::uint16_t>(covered_[cover.node] + change);
    }
  }
}

std::int64_t FootprintPlanner::cover_and_weigh(const Start& start,
                                               const std::vector<std::uint32_t>& chain) {
  std::int64_t score = 0;
  std::int64_t travel = 0;
  double y_m = start.y_m;
  for (const std::uint32_t s : chain) {
    const Spray& spray = candidates_.sprays()[s];
    for (const Cover& cover : candidates_.covers(spray)) {
      score += covered_[cover.node]++ == 0 ? cover.score + extra_[cover.node] : 0;
    }
    travel += prepared_.scoring.travel(spray.y_m - y_m);
    y_m = spray.y_m;
  }
  return score * Scoring::kScore - travel;
}

void FootprintPlanner::improve_routes(std::int64_t rounds) {
  for (std::int64_t round = 0; round < rounds; ++round) {
    bool gained = false;
    for (std::size_t a = 0; a < chains_.size(); ++a) {
      const Start& start = prepared_.starts[a];
      if (!start.usable) {
        continue;
      }
      cover(chains_[a], -1);
      const std::int64_t value =
          solver_.solve(prepared_, candidates_, start, covered_, extra_, trial_);
      if (value > cover_and_weigh(start, chains_[a])) {
        gained = true;
        cover(chains_[a], -1);
        chains_[a].swap(trial_);
        cover(chains_[a], 1);
      }
    }
    if (!gained) {
      return;
    }
  }
}

std::int64_t FootprintPlanner::weigh_all() {
  covered_.assign(prepared_.nodes.size(), 0);
  aside_.swap(extra_);
  extra_.assign(prepared_.nodes.size(), 0);
  std::int64_t value = 0;
  for (std::size_t a = 0; a < chains_.size(); ++a) {
    value += cover_and_weigh(prepared_.starts[a], chains_[a]);
  }
  aside_.swap(extra_);
  return value;
}

std::size_t FootprintPlanner::count_left() const {
  std::size_t left = 0;
  for (std::uint32_t k = 0; k < covered_.size(); ++k) {
    left += covered_[k] == 0 && candidates_.coverable(k) ? 1U : 0U;
  }
  return left;
}

void FootprintPlanner::keep_if_better() {
  const std::int64_t value = weigh_all();
  if (value > best_value_) {
    best_value_ = value;
    best_chains_ = chains_;
  }
}

void FootprintPlanner::search_again() {
  for (auto& chain : chains_) {
    chain.clear();
  }
  covered_.assign(covered_.size(), 0);
  improve_routes(parameters_.improvement_rounds + 1);
  keep_if_better();
}

void FootprintPlanner::pursue_left(std::int64_t patience) {
  chains_ = best_chains_;
  (void)weigh_all();
  std::int64_t fruitless = 0;
  for (std::int64_t round = 0; round < parameters_.improvement_rounds; ++round) {
    if (fruitless == patience || count_left() == 0) {
      break;
    }
    for (std::uint32_t k = 0; k < covered_.size(); ++k) {
      if (covered_[k] == 0) {
        extra_[k] += prepared_.nodes[k].score;
      }
    }
    improve_routes(1);
    const std::int64_t before = best_value_;
    keep_if_better();
    fruitless = best_value_ > before ? 0 : fruitless + 1;
  }
}

void FootprintPlanner::share_out() {
  treated_.assign(prepared_.nodes.size(), Treated{});
  for (std::size_t a = 0; a < chains_.size(); ++a) {
    for (std::uint32_t stop = 0; stop < chains_[a].size(); ++stop) {
      const Spray& spray = candidates_.sprays()[chains_[a][stop]];
      for (const Cover& cover : candidates_.covers(spray)) {
        const Node& node = prepared_.nodes[cover.node];
        const double dx = node.x_m - spray.x_m;
        const double dy = node.y_m - spray.y_m;
        const double squared = dx * dx + dy * dy;
        Treated& treated = treated_[cover.node];
        if (treated.axis < 0 || squared < treated.squared_distance_m2) {
          treated = {squared, static_cast<std::int32_t>(a), stop};
        }
      }
    }
  }
}

void FootprintPlanner::centre_route(const Start& start, std::size_t axis) {
  auto& aims = aims_[axis];
  const auto can_follow = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    return start.follows(from.x(), from.y(), to.x(), to.y());
  };
  for (std::size_t s = 0; s < aims.size(); ++s) {
    Eigen::Vector2d lower = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Vector2d upper = -lower;
    const auto farthest = [&](const Eigen::Vector2d& aim) {
      double squared = 0.0;
      for (const std::uint32_t k : stop_nodes_[s]) {
        const Node& node = prepared_.nodes[k];
        squared = std::max(squared, (Eigen::Vector2d(node.x_m, node.y_m) - aim).squaredNorm());
      }
      return squared;
    };
    for (const std::uint32_t k : stop_nodes_[s]) {
      const Eigen::Vector2d stem(prepared_.nodes[k].x_m, prepared_.nodes[k].y_m);
      lower = lower.cwiseMin(stem);
      upper = upper.cwiseMax(stem);
    }
    const Eigen::Vector2d middle = 0.5 * (lower + upper);
    const Eigen::Vector2d from = aims[s];
    for (const double share : {1.0, 0.75, 0.5, 0.25}) {
      const Eigen::Vector2d aim = from + share * (middle - from);
      const bool follows = s == 0 ? start.reaches(aim.x(), aim.y()) : can_follow(aims[s - 1], aim);
      if (farthest(aim) < farthest(from) && start.spans(aim.y()) && follows &&
          (s + 1 == aims.size() || can_follow(aim, aims[s + 1])) &&
          candidates_.allowed(aim.x(), aim.y())) {
        aims[s] = aim;
        break;
      }
    }
  }
}

void FootprintPlanner::write_routes(const PlanningProblem& problem, Plan& plan) {
  share_out();
  aims_.resize(chains_.size());
  for (std::size_t a = 0; a < chains_.size(); ++a) {
    const Start& start = prepared_.starts[a];
    auto& aims = aims_[a];
    aims.clear();
    if (stop_nodes_.size() < chains_[a].size()) {
      stop_nodes_.resize(chains_[a].size());
    }
    for (std::uint32_t s = 0; s < chains_[a].size(); ++s) {
      const Spray& spray = candidates_.sprays()[chains_[a][s]];
      auto& nodes = stop_nodes_[aims.size()];
      nodes.clear();
      for (const Cover& cover : candidates_.covers(spray)) {
        const Treated& treated = treated_[cover.node];
        if (treated.axis == static_cast<std::int32_t>(a) && treated.stop == s) {
          nodes.push_back(cover.node);
        }
      }
      if (!nodes.empty()) {
        aims.emplace_back(spray.x_m, spray.y_m);
      }
    }
    centre_route(start, a);
    write_route(problem, a, plan);
  }
  explain_left(plan);
}

void FootprintPlanner::write_route(const PlanningProblem& problem, std::size_t axis, Plan& plan) {
  const Start& start = prepared_.starts[axis];
  const auto& aims = aims_[axis];
  double y_m = start.y_m;
  Stop last;
  for (std::size_t s = 0; s < aims.size(); ++s) {
    Stop stop{.aim_F = aims[s]};
    time_stop(start, prepared_.robot_y_m, s == 0 ? nullptr : &last, stop);
    if (parameters_.fire_while_moving) {
      write_passing(problem, axis, s == 0 ? nullptr : &last, stop, plan);
      const auto& route = plan.routes[axis];
      if (!route.empty() && route.back().moving) {
        stop.depart_x_m = route.back().depart_x_m;
      }
    }
    write_stop(problem, axis, stop, stop_nodes_[s], plan);
    plan.travel_m += std::abs(aims[s].y() - y_m);
    y_m = aims[s].y();
    last = stop;
  }
}

void FootprintPlanner::write_passing(const PlanningProblem& problem, std::size_t axis,
                                     const Stop* from, const Stop& to, Plan& plan) {
  const Start& start = prepared_.starts[axis];
  Leg leg{.from = {start.x_m, start.y_m}, .to = to.aim_F};
  if (from != nullptr) {
    leg.from = from->aim_F;
  }
  if (from != nullptr || start.after_spray) {
    leg.dwell_after_from_m = 0.5 * parameters_.dwell_s * prepared_.speed_mps;
  }
  const double radius_m = candidates_.radius_m();
  const auto& nodes = prepared_.nodes;
  auto node = std::lower_bound(nodes.begin(), nodes.end(), leg.from.x() - radius_m,
                               [](const Node& n, double value) { return n.x_m < value; });
  for (; node != nodes.end() && node->x_m <= leg.to.x() + radius_m; ++node) {
    const auto k = static_cast<std::uint32_t>(node - nodes.begin());
    if (treated_[k].axis >= 0) {
      continue;
    }
    const auto spray = passing_spray(start.transition, leg, {node->x_m, node->y_m}, radius_m);
    if (!spray || !start.spans(spray->aim.y()) ||
        !candidates_.allowed(spray->aim.x(), spray->aim.y())) {
      continue;
    }
    treated_[k].axis = static_cast<std::int32_t>(axis);
    passing_nodes_.assign(1, k);
    const double robot_x_m = spray->aim.x() - start.offset_x_m;
    write_stop(problem, axis,
               {.aim_F = spray->aim,
                .robot_x_m = robot_x_m,
                .depart_x_m = robot_x_m - spray->departure_m,
                .position_m = spray->aim.y() - prepared_.robot_y_m,
                .moving = true},
               passing_nodes_, plan);
    return;
  }
}

void FootprintPlanner::write_stop(const PlanningProblem& problem, std::size_t axis, Stop stop,
                                  std::vector<std::uint32_t>& nodes, Plan& plan) {
  stop.first_target = static_cast<std::uint32_t>(plan.treated.size());
  stop.target_count = static_cast<std::uint32_t>(nodes.size());
  plan.routes[axis].push_back(stop);
  // To the micrometre: the middle of a pair is equally far from both, and rounding must not decide.
  const auto distance_um = [&](std::uint32_t k) {
    const Node& node = prepared_.nodes[k];
    return std::llround(1e6 * (Eigen::Vector2d(node.x_m, node.y_m) - stop.aim_F).norm());
  };
  std::sort(nodes.begin(), nodes.end(), [&](std::uint32_t i, std::uint32_t j) {
    return std::pair(distance_um(i), i) < std::pair(distance_um(j), j);
  });
  for (const std::uint32_t k : nodes) {
    const Node& node = prepared_.nodes[k];
    plan.treated.push_back(problem.targets[node.target].id);
    plan.decisions[node.target].decision = Decision::kTreat;
    plan.decisions[node.target].axis = static_cast<std::int32_t>(axis);
    plan.weight += node.weight;
  }
}

void FootprintPlanner::explain_left(Plan& plan) const {
  for (std::uint32_t k = 0; k < prepared_.nodes.size(); ++k) {
    const Node& node = prepared_.nodes[k];
    Decision& decision = plan.decisions[node.target].decision;
    if (decision == Decision::kTreat || candidates_.coverable(k)) {
      plan.weight_bound += node.weight;
    } else {
      decision =
          candidates_.allowed(node.x_m, node.y_m) ? Decision::kOutside : Decision::kProtectedCrop;
    }
  }
}

}  // namespace furrow::planning
