#include "joint_flow.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::planning {

void group_axes(const PreparedProblem& prepared, std::vector<std::vector<std::uint32_t>>& classes) {
  for (auto& axes : classes) {
    axes.clear();
  }
  std::size_t count = 0;
  for (std::uint32_t a = 0; a < prepared.starts.size(); ++a) {
    const Start& start = prepared.starts[a];
    if (!start.usable) {
      continue;
    }
    const auto end = classes.begin() + static_cast<std::ptrdiff_t>(count);
    const auto same = std::find_if(classes.begin(), end, [&](const auto& axes) {
      const Start& other = prepared.starts[axes.front()];
      return other.lower_y_m == start.lower_y_m && other.upper_y_m == start.upper_y_m &&
             other.transition == start.transition;
    });
    if (same != end) {
      same->push_back(a);
      continue;
    }
    if (count == classes.size()) {
      classes.emplace_back();
    }
    classes[count++].push_back(a);
  }
  classes.resize(count);
}

// Node numbers: 0 the source; 1 to axes the starts; then bus, in and out of each member; the sink.

std::int64_t JointFlow::solve(const PreparedProblem& prepared,
                              std::span<const std::uint32_t> members,
                              std::span<const std::uint32_t> axes,
                              std::vector<std::vector<std::uint32_t>>& chains) {
  for (const std::uint32_t axis : axes) {
    chains[axis].clear();
  }
  if (members.empty() || axes.empty()) {
    return 0;
  }
  build(prepared, members, axes);
  flow_.solve(static_cast<int>(axes.size()));
  read_chains(prepared, members, axes, chains);
  std::int64_t score = 0;
  for (const std::uint32_t axis : axes) {
    for (const std::uint32_t k : chains[axis]) {
      score += prepared.nodes[k].score;
    }
  }
  return score;
}

void JointFlow::build(const PreparedProblem& prepared, std::span<const std::uint32_t> members,
                      std::span<const std::uint32_t> axes) {
  axes_ = axes.size();
  const std::size_t n = members.size();
  const std::uint32_t sink = bus(n);
  flow_.reset(sink + 1);
  legs_.clear();
  first_leg_.clear();
  alight_arc_.clear();
  for (std::size_t a = 0; a < axes_; ++a) {
    const Start& start = prepared.starts[axes[a]];
    const auto from = static_cast<std::uint32_t>(1 + a);
    flow_.add_arc(0, from, 1, 0);
    first_leg_.push_back(legs_.size());
    add_legs(prepared, members, start, true, start.x_m, start.y_m, from, 0);
  }
  const Start& rules = prepared.starts[axes[0]];
  const auto many = static_cast<std::int32_t>(axes_);
  for (std::size_t i = 0; i < n; ++i) {
    const Node& node = prepared.nodes[members[i]];
    const std::uint32_t in = bus(i) + 1;
    const std::uint32_t out = bus(i) + 2;
    alight_arc_.push_back(flow_.add_arc(bus(i), in, 1, 0));
    if (i + 1 < n) {
      flow_.add_arc(bus(i), bus(i + 1), many, 0);
    }
    flow_.add_arc(in, out, 1, -node.score * Scoring::kScore);
    flow_.add_arc(out, sink, 1, 0);
    first_leg_.push_back(legs_.size());
    add_legs(prepared, members, rules, false, node.x_m, node.y_m, out, i + 1);
  }
  first_leg_.push_back(legs_.size());
}

void JointFlow::add_legs(const PreparedProblem& prepared, std::span<const std::uint32_t> members,
                         const Start& rules, bool from_start, double x_m, double y_m,
                         std::uint32_t from, std::size_t first) {
  const double farthest_m = std::max(rules.upper_y_m - y_m, y_m - rules.lower_y_m);
  const double always_dx_m =
      from_start ? rules.needed_dx_m(farthest_m) : rules.transition.needed_dx_m(farthest_m);
  std::size_t nearby = 0;
  for (std::size_t i = first; i < members.size(); ++i) {
    const Node& node = prepared.nodes[members[i]];
    const double dx_m = node.x_m - x_m;
    if (dx_m >= always_dx_m && nearby >= kNearby) {
      legs_.push_back(
          {kBus + static_cast<std::uint32_t>(i),
           static_cast<std::uint32_t>(flow_.add_arc(from, bus(i), 1, Scoring::kTravelLevels))});
      return;
    }
    const bool feasible = from_start ? rules.reaches(node.x_m, node.y_m)
                                     : rules.transition.feasible(dx_m, node.y_m - y_m);
    if (feasible) {
      ++nearby;
      legs_.push_back({static_cast<std::uint32_t>(i),
                       static_cast<std::uint32_t>(flow_.add_arc(
                           from, bus(i) + 1, 1, prepared.scoring.travel(node.y_m - y_m)))});
    }
  }
}

void JointFlow::send_on(std::size_t legs, std::size_t axis, double y_m) {
  for (std::size_t l = first_leg_[legs]; l < first_leg_[legs + 1]; ++l) {
    if (flow_.flow(legs_[l].arc) == 0) {
      continue;
    }
    if (legs_[l].to >= kBus) {
      riders_.push_back({axis, y_m, legs_[l].to - kBus});
    } else {
      arrives_[legs_[l].to] = static_cast<std::int32_t>(axis);
    }
    return;
  }
}

void JointFlow::read_chains(const PreparedProblem& prepared, std::span<const std::uint32_t> members,
                            std::span<const std::uint32_t> axes,
                            std::vector<std::vector<std::uint32_t>>& chains) {
  arrives_.assign(members.size(), -1);
  riders_.clear();
  for (std::size_t a = 0; a < axes_; ++a) {
    send_on(a, a, prepared.starts[axes[a]].y_m);
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    const double y_m = prepared.nodes[members[i]].y_m;
    if (flow_.flow(alight_arc_[i]) > 0) {
      // Any rider may get off here; the nearest one travels least.
      auto nearest = riders_.end();
      for (auto rider = riders_.begin(); rider != riders_.end(); ++rider) {
        if (rider->from <= i && (nearest == riders_.end() ||
                                 std::abs(rider->y_m - y_m) < std::abs(nearest->y_m - y_m))) {
          nearest = rider;
        }
      }
      arrives_[i] = static_cast<std::int32_t>(nearest->axis);
      riders_.erase(nearest);
    }
    if (arrives_[i] >= 0) {
      const auto axis = static_cast<std::size_t>(arrives_[i]);
      chains[axes[axis]].push_back(members[i]);
      send_on(axes_ + i, axis, y_m);
    }
  }
}

}  // namespace furrow::planning
