#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "furrow_planning/parameters.hpp"
#include "furrow_planning/types.hpp"
#include "prepared_problem.hpp"

namespace furrow::planning {

/// A place where a spray could be centred, and the targets that it would treat.
struct Spray {
  double x_m = 0.0;
  double y_m = 0.0;
  std::uint32_t first = 0;  ///< into SprayCandidates::covers
  std::uint32_t count = 0;
};

struct Cover {
  std::uint32_t node = 0;
  std::int64_t score = 0;  ///< of the node, less for a stem away from the centre
};

/// The candidate placements of the footprint planner, by x. No candidate lies in a protection zone
/// or treats nothing.
/// - Each stem: on it, and shifted along the travel, where robot motion gains the most time.
/// - Each pair of stems under one footprint: the middle of the region that treats both, and its
///   ends along the travel.
/// - Each triple: the centre of its smallest circle.
/// - Each stem too near to a crop or to the end of the span: the nearest allowed place.
class SprayCandidates {
 public:
  /// For targets with x >= `from_x_m`. `extra`: places to be offered as well (of the last plan).
  void build(const PlanningProblem& problem, const PlannerParameters& parameters,
             const PreparedProblem& prepared, double from_x_m,
             std::span<const Eigen::Vector2d> extra);

  [[nodiscard]] const std::vector<Spray>& sprays() const { return sprays_; }
  [[nodiscard]] std::span<const Cover> covers(const Spray& spray) const {
    return std::span(covers_).subspan(spray.first, spray.count);
  }
  [[nodiscard]] double radius_m() const { return radius_m_; }
  /// Whether any placement treats the node (for nodes from from_x_m on).
  [[nodiscard]] bool coverable(std::uint32_t node) const { return coverable_[node] != 0; }
  /// Whether a spray at the place keeps out of all protection zones.
  [[nodiscard]] bool allowed(double x_m, double y_m) const;

 private:
  struct Zone {
    double x_m = 0.0;
    double y_m = 0.0;
    double radius_m = 0.0;
  };
  void sort_zones(const PlanningProblem& problem, const PlannerParameters& parameters);
  void offer(double x_m, double y_m);
  void offer_single(const Node& node);
  void offer_pair(const Node& a, const Node& b);
  void offer_triple(const Node& a, const Node& b, const Node& c);
  void offer_beside_zones(const Node& node);

  const PreparedProblem* prepared_ = nullptr;
  double radius_m_ = 0.0;
  double centre_preference_ = 0.0;
  double lower_y_m_ = 0.0;
  double upper_y_m_ = 0.0;
  double widest_zone_m_ = 0.0;
  std::vector<Zone> zones_;  ///< by x
  std::vector<Spray> sprays_;
  std::vector<Cover> covers_;
  std::vector<char> coverable_;
};

}  // namespace furrow::planning
