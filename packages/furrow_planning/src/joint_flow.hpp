#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "min_cost_flow.hpp"
#include "prepared_problem.hpp"

namespace furrow::planning {

/// Writes the axes in service as classes that agree in span and limits.
void group_axes(const PreparedProblem& prepared, std::vector<std::vector<std::uint32_t>>& classes);

/// The exact joint optimum of axes that agree in span and limits: disjoint chains, one for each
/// axis, of greatest total score, and among those of least travel.
///
/// Target k can follow target j depending on their positions, the robot's speed and the axis's
/// limits only. The axis's offset along x shifts both crossings alike. So one flow network over the
/// targets serves all axes; an axis enters it through an arc of its own, which carries its start
/// and offset. Each unit of flow is one axis, a target's arc has capacity one, and the flow
/// decomposes into chains by following it from each start.
///
/// A bus keeps the number of arcs linear: nodes in the order of x that any number of axes may use.
/// Moves over a distance in which the axis could cross its whole span go over the bus. Travel over
/// the bus costs the greatest move. So ties are broken by travel exactly where each stop is
/// followed by one of the kNearby nearest targets or by one within that distance, else
/// approximately.
class JointFlow {
 public:
  static constexpr std::size_t kNearby = 12;

  /// `members`: nodes, ascending, all within the span. `axes`: which starts take part; chains[a] is
  /// written for these. Returns the total score.
  std::int64_t solve(const PreparedProblem& prepared, std::span<const std::uint32_t> members,
                     std::span<const std::uint32_t> axes,
                     std::vector<std::vector<std::uint32_t>>& chains);

 private:
  struct Leg {  ///< an arc out of a start or a target; to kBus + i: onto the bus at member i
    std::uint32_t to = 0;
    std::uint32_t arc = 0;
  };
  struct Rider {
    std::size_t axis = 0;
    double y_m = 0.0;
    std::size_t from = 0;  ///< member at which it boards
  };
  static constexpr std::uint32_t kBus = 1U << 31U;

  [[nodiscard]] std::uint32_t bus(std::size_t i) const {
    return static_cast<std::uint32_t>(1 + axes_ + 3 * i);
  }
  void build(const PreparedProblem& prepared, std::span<const std::uint32_t> members,
             std::span<const std::uint32_t> axes);
  /// The arcs of a start (`from_start`) or of a target at (x, y) to members from `first` on.
  void add_legs(const PreparedProblem& prepared, std::span<const std::uint32_t> members,
                const Start& rules, bool from_start, double x_m, double y_m, std::uint32_t from,
                std::size_t first);
  void read_chains(const PreparedProblem& prepared, std::span<const std::uint32_t> members,
                   std::span<const std::uint32_t> axes,
                   std::vector<std::vector<std::uint32_t>>& chains);
  void send_on(std::size_t legs, std::size_t axis, double y_m);

  std::size_t axes_ = 0;
  MinCostFlow flow_;
  std::vector<Leg> legs_;
  std::vector<std::size_t> first_leg_;   ///< of starts, then members, then the end
  std::vector<std::size_t> alight_arc_;  ///< from the bus to a member
  std::vector<std::int32_t> arrives_;    ///< axis that arrives at a member by a leg, or -1
  std::vector<Rider> riders_;
};

}  // namespace furrow::planning
