#include <utility>

#include "field_markers.hpp"
#include "furrow_components/tool_file.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

struct Parameters {
  ToolFileParameters tool;
  double crop_threshold = 0.5;

  void visit(ParameterVisitor& v) {
    tool.visit(v);
    v.visit({.name = "crop_threshold",
             .description = "tracks with at least this crop probability are drawn as crop",
             .min = 0.0,
             .max = 1.0},
            crop_threshold);
  }
};

/// Publishes plants, plan and sprays as markers.
class Markers final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("Draws plants, plan and sprays for RViz.")
        .parameters<Parameters>()
        .input<topics::Tracks>()
        .input<topics::Plan>(graph::Need::kOptional)
        .input<topics::AxisEvent>(graph::Need::kOptional)
        .output<topics::Markers>();
  }

  explicit Markers(graph::Context& context) : Markers(context, context.parameters<Parameters>()) {}

 private:
  Markers(graph::Context& context, const Parameters& parameters)
      : markers_(geometry::load_tool_model(parameters.tool.tool_file), parameters.crop_threshold),
        out_(context.output<topics::Markers>()) {
    context.input<topics::Tracks>(
        [this](const auto& message) { publish(markers_.plants(*message)); });
    context.input<topics::Plan>([this](const auto& message) { publish(markers_.plan(*message)); });
    context.input<topics::AxisEvent>(
        [this](const auto& message) { publish(markers_.spray(*message)); });
  }

  void publish(visualization_msgs::msg::MarkerArray markers) const {
    if (!markers.markers().empty()) out_.publish(std::move(markers));
  }

  FieldMarkers markers_;
  graph::Output<topics::Markers> out_;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::Markers>("markers");
}
