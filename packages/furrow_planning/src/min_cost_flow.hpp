#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace furrow::planning {

/// Minimum-cost flow by successive shortest paths with potentials (Ahuja, Magnanti and Orlin 1993,
/// ch. 9) on a graph whose nodes are numbered in topological order, so that the first potentials
/// come from one pass. Costs may be negative. Keeps its memory.
class MinCostFlow {
 public:
  void reset(std::size_t nodes);
  /// @pre from < to. Returns the arc's number.
  std::size_t add_arc(std::uint32_t from, std::uint32_t to, std::int32_t capacity,
                      std::int64_t cost);
  /// Sends up to `max_flow` units, one after the other, from node 0 to the last one, as long as
  /// each lowers the cost. Returns the total cost.
  std::int64_t solve(int max_flow);
  /// Units on an arc, once solved.
  [[nodiscard]] std::int32_t flow(std::size_t arc) const;

 private:
  struct Given {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    std::int32_t capacity = 0;
    std::int64_t cost = 0;
  };
  struct Arc {
    std::uint32_t to = 0;
    std::uint32_t reverse = 0;
    std::int64_t cost = 0;
    std::int32_t capacity = 0;
  };

  void build();
  bool first_paths();
  bool shortest_paths();
  void augment();

  std::size_t nodes_ = 0;
  std::vector<Given> given_;
  std::vector<std::uint32_t> position_;  ///< of a given arc in arcs_
  std::vector<std::uint32_t> first_;     ///< of a node's arcs in arcs_
  std::vector<Arc> arcs_;
  std::vector<std::int64_t> potential_;
  std::vector<std::int64_t> distance_;
  std::vector<std::uint32_t> via_;  ///< arc by which the shortest path enters a node
  std::vector<std::pair<std::int64_t, std::uint32_t>> heap_;
};

}  // namespace furrow::planning
