#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::vision {

/// What every detector with a trained network is told; what visit() declares says each.
struct NetworkUse {
  double crop_log_odds = 0.0;  ///< beside the model file's
  std::int64_t input_area_max_px = 2'000'000;
  std::vector<std::string> classes;
  void visit(ParameterVisitor& v);
};

}  // namespace furrow::vision
