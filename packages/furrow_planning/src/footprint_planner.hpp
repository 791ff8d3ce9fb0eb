#pragma once

#include <cstdint>
#include <vector>

#include "furrow_planning/route_planner.hpp"
#include "joint_flow.hpp"
#include "spray_candidates.hpp"
#include "spray_chain.hpp"

namespace furrow::planning {

/// Plans sprays as discs that may be centred anywhere and treat several targets. A local search
/// over the placements of SprayCandidates:
/// 1. Start from the exact joint routes of sprays on single stems, which also keep the travel low.
/// 2. Improve one axis after the other, each optimal against the others, until nothing is gained.
/// 3. Where many targets are missed, search a second time from empty routes.
/// 4. Raise the scores of the missed targets and improve again, round by round, to leave the local
///    optimum (breakout method: Morris 1993).
/// The best plan by the true scores wins. Plan::weight_bound counts every target that some
/// placement treats.
class FootprintPlanner final : public RoutePlanner {
 public:
  explicit FootprintPlanner(const PlannerParameters& parameters) : parameters_(parameters) {}
  [[nodiscard]] Status plan(const PlanningProblem& problem, Plan& plan) override;
  [[nodiscard]] std::string_view name() const override { return "footprint joint"; }

 private:
  struct Treated {  ///< by which spray a node is treated, once the chains stand
    double squared_distance_m2 = 0.0;
    std::int32_t axis = -1;
    std::uint32_t stop = 0;
  };

  void start_from_stems();
  /// Until nothing is gained, at most so often; by the scores with what is extra.
  void improve_routes(std::int64_t rounds);
  void search_again();
  /// From the best chains; ends after so many rounds without gain.
  void pursue_left(std::int64_t patience);
  /// Targets that are left though some placement treats them.
  [[nodiscard]] std::size_t count_left() const;
  void keep_if_better();
  /// What all chains are worth together by the true scores.
  std::int64_t weigh_all();
  /// Adds (or takes away) what a chain covers.
  void cover(const std::vector<std::uint32_t>& chain, int change);
  /// The same as adding; returns what the chain is worth against what was covered before.
  std::int64_t cover_and_weigh(const Start& start, const std::vector<std::uint32_t>& chain);
  /// Each node to the nearest spray that covers it.
  void share_out();
  void write_routes(const PlanningProblem& problem, Plan& plan);
  /// Moves the sprays of a route towards the middle of what they treat, as far as its neighbours,
  /// the span and the zones allow.
  void centre_route(const Start& start, std::size_t axis);
  /// The sprays of one axis, in order, with what is fired in passing on the way to each.
  void write_route(const PlanningProblem& problem, std::size_t axis, Plan& plan);
  void write_passing(const PlanningProblem& problem, std::size_t axis, const Stop* from,
                     const Stop& to, Plan& plan);
  void write_stop(const PlanningProblem& problem, std::size_t axis, Stop stop,
                  std::vector<std::uint32_t>& nodes, Plan& plan);
  void explain_left(Plan& plan) const;

  PlannerParameters parameters_;
  PreparedProblem prepared_;
  SprayCandidates candidates_;
  SprayChainSolver solver_;
  JointFlow flow_;
  std::vector<std::vector<std::uint32_t>> classes_;
  std::vector<std::uint32_t> members_;
  std::vector<std::vector<std::uint32_t>> chains_;
  std::vector<std::vector<std::uint32_t>> best_chains_;
  std::int64_t best_value_ = 0;
  std::vector<std::uint32_t> trial_;
  std::vector<std::uint16_t> covered_;  ///< by node
  std::vector<std::int64_t> extra_;     ///< by node, on top of its score
  std::vector<std::int64_t> aside_;     ///< its values while the true scores count
  std::vector<std::uint32_t> passing_nodes_;
  std::vector<Treated> treated_;                        ///< by node
  std::vector<std::vector<Eigen::Vector2d>> aims_;      ///< by axis and stop
  std::vector<std::vector<std::uint32_t>> stop_nodes_;  ///< by stop of the axis at hand
};

}  // namespace furrow::planning
