#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "rig.hpp"

namespace furrow::actuation::testing {

inline Twist2 steady(double) {
  return {0.5, 0.0, 0.0};
}

inline SimulatedAxisParameters ready() {
  SimulatedAxisParameters parameters;
  parameters.start_ready = true;
  return parameters;
}

/// One axis at 0.5 m/s on a plan that is sent again at 50 Hz.
class Trip {
 public:
  explicit Trip(const AxisControllerParameters& parameters = {}, Rig::Speed speed = steady,
                const SimulatedAxisParameters& drive = ready())
      : rig(1, parameters, {}, {}, drive, std::move(speed)) {}

  void run(double seconds) {
    for (double t = 0.0; t < seconds; t += 0.002) {
      if (send_plan) send();
      rig.step();
      opened_now = opened_now || axis().output.valve_open;
    }
  }
  void reset(SafetyCause cause = SafetyCause::kNone) {
    axis().loop.request_reset(rig.now(), cause);
  }
  ToolSafety& safety() { return axis().controller.safety(); }
  void send() {
    auto stops = plan;
    for (auto& stop : stops) {
      if (fresh) stop.observed = rig.now();
    }
    ASSERT_TRUE(axis().controller.set_plan(rig.now(), stops).ok());
  }
  Rig::Axis& axis() { return rig.axis(0); }
  [[nodiscard]] int count(ControllerEventKind kind) {
    int n = 0;
    for (const auto& event : axis().events) n += event.kind == kind ? 1 : 0;
    return n;
  }
  [[nodiscard]] ControllerEvent last(ControllerEventKind kind) {
    ControllerEvent found;
    for (const auto& event : axis().events) {
      if (event.kind == kind) found = event;
    }
    return found;
  }

  Rig rig;
  std::vector<PlannedStop> plan;
  bool send_plan = true;
  bool fresh = true;
  bool opened_now = false;
};

}  // namespace furrow::actuation::testing
