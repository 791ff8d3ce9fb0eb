#include "assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace furrow::planning {
namespace {

void assign_by_distance(const PreparedProblem& prepared,
                        std::vector<std::vector<std::uint32_t>>& members) {
  for (std::uint32_t k = 0; k < prepared.nodes.size(); ++k) {
    const Node& node = prepared.nodes[k];
    double nearest_m = std::numeric_limits<double>::infinity();
    std::size_t axis = prepared.starts.size();
    for (std::size_t a = 0; a < prepared.starts.size(); ++a) {
      const Start& start = prepared.starts[a];
      if (!start.usable || !start.spans(node.y_m)) {
        continue;
      }
      const bool first = members[a].empty();
      const double x_m = first ? start.x_m : prepared.nodes[members[a].back()].x_m;
      const double y_m = first ? start.y_m : prepared.nodes[members[a].back()].y_m;
      const double distance_m = std::hypot(node.x_m - x_m, node.y_m - y_m);
      if (distance_m < nearest_m) {
        nearest_m = distance_m;
        axis = a;
      }
    }
    if (axis < members.size()) {
      members[axis].push_back(k);
    }
  }
}

/// Gives each node to the axis in whose lane it lies; `share(node)` in [0, 1] runs over the lanes.
template <class Share>
void assign_by_lane(const PreparedProblem& prepared, const Share& share,
                    std::vector<std::vector<std::uint32_t>>& members) {
  std::size_t lanes = 0;
  for (const Start& start : prepared.starts) {
    lanes += start.usable ? 1U : 0U;
  }
  if (lanes == 0) {
    return;
  }
  for (std::uint32_t k = 0; k < prepared.nodes.size(); ++k) {
    const double place = share(k) * static_cast<double>(lanes);
    std::size_t lane = place > 0.0 ? static_cast<std::size_t>(place) : 0U;
    lane = std::min(lane, lanes - 1);
    for (std::size_t a = 0; a < prepared.starts.size(); ++a) {
      if (prepared.starts[a].usable && lane-- == 0) {
        if (prepared.starts[a].spans(prepared.nodes[k].y_m)) {
          members[a].push_back(k);
        }
        break;
      }
    }
  }
}

}  // namespace

void assign(Assignment assignment, const PreparedProblem& prepared,
            std::vector<std::vector<std::uint32_t>>& members) {
  members.resize(prepared.starts.size());
  for (auto& of_axis : members) {
    of_axis.clear();
  }
  if (assignment == Assignment::kDistance) {
    assign_by_distance(prepared, members);
    return;
  }
  if (assignment == Assignment::kStatic) {
    double lower_m = std::numeric_limits<double>::infinity();
    double upper_m = -lower_m;
    for (const Start& start : prepared.starts) {
      if (start.usable) {
        lower_m = std::min(lower_m, start.lower_y_m);
        upper_m = std::max(upper_m, start.upper_y_m);
      }
    }
    assign_by_lane(
        prepared,
        [&](std::uint32_t k) { return (prepared.nodes[k].y_m - lower_m) / (upper_m - lower_m); },
        members);
    return;
  }
  std::vector<std::uint32_t> by_y(prepared.nodes.size());
  double sum = 0.0;
  for (std::uint32_t k = 0; k < by_y.size(); ++k) {
    by_y[k] = k;
    sum += prepared.nodes[k].weight;
  }
  std::sort(by_y.begin(), by_y.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Node& left = prepared.nodes[a];
    const Node& right = prepared.nodes[b];
    return left.y_m != right.y_m ? left.y_m < right.y_m : a < b;
  });
  std::vector<double> share(by_y.size());
  double before = 0.0;
  for (const std::uint32_t k : by_y) {
    share[k] = (before + 0.5 * prepared.nodes[k].weight) / sum;
    before += prepared.nodes[k].weight;
  }
  assign_by_lane(
      prepared, [&](std::uint32_t k) { return share[k]; }, members);
}

}  // namespace furrow::planning
