#pragma once

#include <string>

#include "furrow_core/parameters.hpp"
#include "furrow_vision/detector_choice.hpp"
#include "furrow_vision/growth_stage.hpp"

namespace furrow::components {

struct PerceptionParameters {
  vision::DetectorParameters detector;
  double ground_distance_m = 1.0;
  double min_score = 0.3;
  bool use_depth = true;
  std::string without_depth = "drop";
  double depth_unit_m = 0.001;
  double depth_tolerance_s = 0.02;
  double depth_patience_s = 0.1;
  bool rectified = false;
  vision::GrowthStageParameters growth;

  void visit(ParameterVisitor& v);

 private:
  void visit_depth(ParameterVisitor& v);
};

}  // namespace furrow::components
