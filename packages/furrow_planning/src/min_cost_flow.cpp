#include "min_cost_flow.hpp"

#include <algorithm>
#include <cassert>
#include <functional>
#include <limits>

namespace furrow::planning {
namespace {

constexpr std::int64_t kFar = std::numeric_limits<std::int64_t>::max() / 4;

}  // namespace

void MinCostFlow::reset(std::size_t nodes) {
  nodes_ = nodes;
  given_.clear();
}

std::size_t MinCostFlow::add_arc(std::uint32_t from, std::uint32_t to, std::int32_t capacity,
                                 std::int64_t cost) {
  assert(from < to && to < nodes_);
  given_.push_back({from, to, capacity, cost});
  return given_.size() - 1;
}

std::int32_t MinCostFlow::flow(std::size_t arc) const {
  return given_[arc].capacity - arcs_[position_[arc]].capacity;
}

void MinCostFlow::build() {
  first_.assign(nodes_ + 1, 0);
  for (const Given& arc : given_) {
    ++first_[arc.from + 1];
    ++first_[arc.to + 1];
  }
  for (std::size_t v = 0; v < nodes_; ++v) {
    first_[v + 1] += first_[v];
  }
  via_.assign(first_.begin(), first_.end() - 1);  // the next free place of each node
  arcs_.resize(2 * given_.size());
  position_.resize(given_.size());
  for (std::size_t i = 0; i < given_.size(); ++i) {
    const Given& arc = given_[i];
    const std::uint32_t forward = via_[arc.from]++;
    const std::uint32_t backward = via_[arc.to]++;
    arcs_[forward] = {arc.to, backward, arc.cost, arc.capacity};
    arcs_[backward] = {arc.from, forward, -arc.cost, 0};
    position_[i] = forward;
  }
}

bool MinCostFlow::first_paths() {
  distance_.assign(nodes_, kFar);
  distance_[0] = 0;
  for (std::uint32_t v = 0; v < nodes_; ++v) {
    if (distance_[v] >= kFar) {
      continue;
    }
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
      const Arc& arc = arcs_[i];
      if (arc.capacity > 0 && distance_[v] + arc.cost < distance_[arc.to]) {
        distance_[arc.to] = distance_[v] + arc.cost;
        via_[arc.to] = i;
      }
    }
  }
  potential_.assign(distance_.begin(), distance_.end());
  return distance_.back() < kFar;
}

bool MinCostFlow::shortest_paths() {
  const std::uint32_t sink = static_cast<std::uint32_t>(nodes_ - 1);
  distance_.assign(nodes_, kFar);
  distance_[0] = 0;
  heap_.clear();
  heap_.emplace_back(0, 0U);
  const std::greater<> later;
  while (!heap_.empty()) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    const auto [distance, v] = heap_.back();
    heap_.pop_back();
    if (v == sink) {
      break;
    }
    if (distance > distance_[v]) {
      continue;
    }
    const std::int64_t base = distance + potential_[v];
    for (std::uint32_t i = first_[v]; i < first_[v + 1]; ++i) {
      const Arc& arc = arcs_[i];
      if (arc.capacity <= 0 || potential_[arc.to] >= kFar) {
        continue;
      }
      const std::int64_t reached = base + arc.cost - potential_[arc.to];
      if (reached < distance_[arc.to]) {
        distance_[arc.to] = reached;
        via_[arc.to] = i;
        heap_.emplace_back(reached, arc.to);
        std::push_heap(heap_.begin(), heap_.end(), later);
      }
    }
  }
  const std::int64_t to_sink = distance_[sink];
  if (to_sink >= kFar) {
    return false;
  }
  for (std::size_t v = 0; v < nodes_; ++v) {
    if (potential_[v] < kFar) {
      potential_[v] += std::min(distance_[v], to_sink);
    }
  }
  return true;
}

void MinCostFlow::augment() {
  for (std::uint32_t v = static_cast<std::uint32_t>(nodes_ - 1); v != 0;) {
    Arc& arc = arcs_[via_[v]];
    --arc.capacity;
    ++arcs_[arc.reverse].capacity;
    v = arcs_[arc.reverse].to;
  }
}

std::int64_t MinCostFlow::solve(int max_flow) {
  build();
  std::int64_t total = 0;
  for (int unit = 0; unit < max_flow; ++unit) {
    const bool found = unit == 0 ? first_paths() : shortest_paths();
    // Potentials are true distances of the residual graph from node 0, whose potential stays 0.
    if (!found || potential_.back() >= 0) {
      break;
    }
    total += potential_.back();
    augment();
  }
  return total;
}

}  // namespace furrow::planning
