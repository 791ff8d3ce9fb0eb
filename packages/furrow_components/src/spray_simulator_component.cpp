#include <memory>
#include <string>

#include "furrow_graph/registry.hpp"
#include "furrow_msgs/nav_msgs.h"
#include "spray_landing.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  std::string tool_file;
  double rate_hz = 100.0;
  simulation::SprayParameters spray;
  simulation::ValveFaultParameters valve_faults;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
    v.visit({.name = "rate_hz",
             .unit = "Hz",
             .description = "rate of the true odometry",
             .min = 1.0,
             .max = 1000.0},
            rate_hz);
    PrefixedVisitor spray_visitor(v, "spray_");
    spray.visit(spray_visitor);
    PrefixedVisitor fault_visitor(v, "valve_fault_");
    valve_faults.visit(fault_visitor);
  }
};

/// Simulates the landing of sprays over a recorded true motion; without one it publishes nothing.
class SpraySimulator final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Simulates the landing of sprays over the true motion of a recording.")
        .parameters<Parameters>()
        .input<topics::TrueOdometry>(graph::Need::kOptional)
        .input<topics::AxisEvent>(graph::Need::kOptional)
        .input<topics::AxisState>(graph::Need::kOptional)
        .output<topics::TrueSpray>();
  }

  explicit SpraySimulator(graph::Context& context)
      : parameters_(context.parameters<Parameters>()),
        landing_(context, geometry::load_tool_model(parameters_.tool_file), parameters_.spray,
                 parameters_.valve_faults, Duration::seconds(2.0 / parameters_.rate_hz)) {
    context.input<topics::TrueOdometry>([this, &context](const auto& truth) {
      if (!landing_.move(*truth)) {
        context.warn("bad_odometry", "true odometry goes back in time; it was not used");
      }
    });
    context.input<topics::AxisEvent>([this](const auto& event) { landing_.take(*event); });
    context.input<topics::AxisState>([this](const auto& state) { landing_.take(*state); });
  }

 private:
  Parameters parameters_;
  SprayLanding landing_;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::SpraySimulator>("spray_simulator");
}
