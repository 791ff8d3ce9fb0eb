#pragma once

#include <cstdint>
#include <string>

#include "furrow_core/parameters.hpp"

namespace furrow::planning {

/// Parameters of route planning. Defaults: the best planner, and the paper's figures.
struct PlannerParameters {
  std::string planner = "footprint";
  std::string assignment = "joint";
  std::string view = "rolling";
  std::string kinematics = "velocity";
  double rho = 0.6;
  double omega = 20.0;
  std::string speed_source = "nominal";
  double speed_mps = 0.5;
  double dwell_s = 0.0;
  double settle_s = 0.0;
  double footprint_radius_m = 0.025;
  double placement_margin_m = 0.0;
  double centre_preference = 0.001;
  double protection_zone_mm = 0.0;
  bool fire_while_moving = false;
  double min_weight = 0.0;
  double commit_s = 0.1;
  double segment_length_m = 1.0;
  std::int64_t notsp_targets = 6;
  std::int64_t permutation_targets = 9;
  std::int64_t improvement_rounds = 8;
  std::int64_t threads = 1;
  std::int64_t max_targets = 20000;

  void visit(ParameterVisitor& v);

 private:
  void visit_method(ParameterVisitor& v);
  void visit_motion(ParameterVisitor& v);
  void visit_sprays(ParameterVisitor& v);
  void visit_search(ParameterVisitor& v);
};

}  // namespace furrow::planning
