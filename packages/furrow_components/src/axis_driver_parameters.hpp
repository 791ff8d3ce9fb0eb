#pragma once

#include <string>

#include "axis_hardware.hpp"
#include "furrow_actuation/axis_controller_types.hpp"
#include "furrow_actuation/nozzle.hpp"

namespace furrow::components {

struct AxisDriverParameters {
  std::string tool_file;
  std::string axis;
  double rate_hz = 500.0;
  double state_rate_hz = 50.0;
  double protect_threshold = 0.3;
  double protected_range_m = 1.0;
  std::string latch_folder;
  std::string nozzle_file;
  actuation::NozzleCalibration nozzle;
  actuation::AxisControllerParameters controller;
  AxisHardwareParameters hardware;

  void visit(ParameterVisitor& v);
};

}  // namespace furrow::components
