#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "axis_conversion.hpp"
#include "axis_driver_parameters.hpp"
#include "axis_reporter.hpp"
#include "furrow_actuation/latch_store.hpp"
#include "furrow_actuation/tool_loop.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_components/nozzle_file.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/nav_msgs.h"

namespace furrow::components {
namespace {

namespace topics = msgs::topics;

const geometry::AxisModel& find_axis(const geometry::ToolModel& tool, const std::string& name) {
  const auto it = std::ranges::find(tool.axes, name, &geometry::AxisModel::name);
  if (it == tool.axes.end()) throw ConfigError("axis: the tool has no joint '" + name + "'");
  return *it;
}

AxisDriverParameters with_nozzle_file(AxisDriverParameters parameters) {
  if (!parameters.nozzle_file.empty()) {
    parameters.nozzle = load_nozzle(parameters.nozzle_file, parameters.axis);
  }
  return parameters;
}

std::unique_ptr<actuation::LatchStore> open_latches(const AxisDriverParameters& parameters) {
  if (parameters.latch_folder.empty()) return nullptr;
  return std::make_unique<actuation::LatchStore>(std::filesystem::path(parameters.latch_folder) /
                                                 (parameters.axis + ".latches"));
}

/// Drives one axis and its nozzle. The only owner of their safe state (docs/decisions/0009).
class AxisDriverComponent final : public graph::Component {
 public:
  static void describe(graph::Description& d) {
    d.doc("One axis and its nozzle: moves to its stops, sprays, and owns the safe state.")
        .parameters<AxisDriverParameters>()
        .input<topics::Plan>()
        .input<topics::PlannerHeartbeat>()
        .input<topics::RobotOdometry>()
        .input<topics::Tracks>()
        .input<topics::EmergencyStop>(graph::Need::kOptional)
        .input<topics::ToolReset>(graph::Need::kOptional)
        .input<topics::ToolEnable>(graph::Need::kOptional)
        .output<topics::AxisState>()
        .output<topics::AxisEvent>()
        .output<topics::JointStates>()
        .output<topics::Diagnostics>();
  }

  explicit AxisDriverComponent(graph::Context& context)
      : context_(context),
        parameters_(with_nozzle_file(context.parameters<AxisDriverParameters>())),
        axis_(find_axis(geometry::load_tool_model(parameters_.tool_file), parameters_.axis)),
        latches_(open_latches(parameters_)),
        controller_(axis_, parameters_.nozzle, parameters_.controller),
        driver_(make_axis_driver(parameters_.hardware, actuation::MotionLimits::of(axis_))),
        valve_(make_valve(parameters_.hardware)),
        stop_input_(make_emergency_input(parameters_.hardware)),
        loop_(controller_, *driver_, *valve_, Duration::seconds(1.0 / parameters_.rate_hz),
              parameters_.controller.safety.loop_deadline_s, [this] { return context_.now(); }),
        reporter_(context, axis_.name, parameters_.nozzle.flow_mlps,
                  parameters_.nozzle.close_delay_s) {
    if (latches_) {
      controller_.safety().restore(latches_->loaded(), context.now());
      if (!latches_->loaded().empty()) {
        context.warn("latches_restored",
                     "the safe state of before the restart holds until tool/reset");
      }
    }
    bind_inputs(context);
    context.every(Duration::seconds(1.0 / parameters_.rate_hz), [this](Time now) { control(now); });
    context.every(Duration::seconds(1.0 / parameters_.state_rate_hz), [this](Time now) {
      reporter_.publish_state(now, controller_, driver_->reading());
      reporter_.update_health(now, controller_.safety(), loop_.supervisor().refusal(),
                              not_confirmed());
    });
    context.every(Duration::milliseconds(1000), [this](Time) {
      reporter_.publish_diagnostics(loop_.supervisor().refusal(), not_confirmed(), latch_remark());
    });
  }

  /// Leaves the hardware in its safe state, and prints which device did not confirm it.
  ~AxisDriverComponent() override {
    if (!last_cycle_) return;
    constexpr double kPatience_s = 0.5;
    const actuation::StopConfirmation confirmed = loop_.shut_down(*last_cycle_, kPatience_s);
    if (!confirmed.valve_shut) tell_at_exit("that its valve is shut");
    if (!confirmed.power_off) tell_at_exit("that the drive stands without power");
  }

 private:
  void bind_inputs(graph::Context& context) {
    context.input<topics::Plan>([this](const auto& plan) { take(*plan); });
    context.input<topics::PlannerHeartbeat>(
        [this](const auto&) { controller_.safety().heartbeat_came(context_.arrival()); });
    context.input<topics::RobotOdometry>([this](const auto& message) {
      const BaseOdometry base = from_msg(*message);
      const actuation::Twist2 twist_B{base.speed_mps, 0.0, base.yaw_rate_radps};
      if (!controller_.set_odometry(context_.arrival(), {base.stamp, base.X_FB, twist_B})) {
        context_.count("odometry_not_used");
      }
      if (std::isfinite(base.X_FB.x_m)) base_x_m_ = base.X_FB.x_m;
    });
    context.input<topics::Tracks>([this](const auto& tracks) { protect(*tracks); });
    context.input<topics::EmergencyStop>(
        [this](const auto& stop) { emergency_stop_ = stop->active(); });
    context.input<topics::ToolEnable>(
        [this](const auto& tool) { controller_.safety().set_active(tool->active()); });
    context.input<topics::ToolReset>([this](const auto& message) { reset(*message); });
  }

  void take(const furrow_msgs::msg::Plan& plan) {
    const auto route = std::ranges::find_if(
        plan.routes(), [this](const auto& r) { return r.axis() == axis_.name; });
    stops_.clear();
    if (route != plan.routes().end()) {
      for (const auto& stop : route->stops()) stops_.push_back(from_msg(stop));
    }
    // The deadline counts from the arrival: the stamp is that of the newest image.
    if (const Status taken = controller_.set_plan(context_.arrival(), stops_); !taken.ok()) {
      context_.warn("bad_plans", taken.error().message + "; the plan was not used");
    }
  }

  // A plant with a probability that is NaN stays protected.
  void protect(const furrow_msgs::msg::Tracks& tracks) {
    protected_.clear();
    const double x_m = base_x_m_ + axis_.p_BN0.x();
    for (const auto& track : tracks.tracks()) {
      const bool other = track.crop_probability() < parameters_.protect_threshold;
      const Eigen::Vector2d p_F = from_point(track.position()).head<2>();
      const bool far = std::abs(p_F.x() - x_m) > parameters_.protected_range_m;
      if (track.confirmed() && !other && !far) protected_.push_back({track.id(), p_F});
    }
    controller_.set_protected(graph::from_msg(tracks.header().stamp()), protected_);
  }

  void reset(const furrow_msgs::msg::ToolReset& message) {
    if (!message.axis().empty() && message.axis() != axis_.name) return;
    const auto cause = msgs::from_msg(message.cause());
    if (!cause.ok()) {
      context_.warn("unknown_values", cause.error().message + "; nothing was reset");
      return;
    }
    loop_.request_reset(context_.now(), safety_cause(*cause));
  }

  void control(Time now) {
    last_cycle_ = now;
    controller_.safety().set_emergency_stop(emergency_stop_ ||
                                            (stop_input_ && stop_input_->pressed()));
    const actuation::CycleReport& cycle = loop_.cycle(now);
    if (latches_) latches_->keep(controller_.safety().latched());
    reporter_.report(now, cycle, driver_->reading());
  }

  [[nodiscard]] std::string not_confirmed() const {
    std::string text(driver_->unconfirmed());
    const std::string_view valve = valve_->unconfirmed();
    if (!text.empty() && !valve.empty()) text += "; ";
    return text.append(valve);
  }

  [[nodiscard]] std::string latch_remark() const {
    if (!latches_) return "not kept over a restart (latch_folder is empty)";
    const std::string failure = latches_->failure();
    return failure.empty() ? "kept" : "not written: " + failure;
  }

  void tell_at_exit(const char* what) {
    context_.count("not_confirmed_at_exit");
    context_.log(log::Level::kError, std::string("not confirmed at the exit: ") + what);
  }

  graph::Context& context_;
  AxisDriverParameters parameters_;
  geometry::AxisModel axis_;
  std::unique_ptr<actuation::LatchStore> latches_;  ///< null: latches are not kept
  actuation::AxisController controller_;
  std::unique_ptr<actuation::AxisDriver> driver_;
  std::unique_ptr<actuation::ValveDriver> valve_;
  std::unique_ptr<actuation::EmergencyInput> stop_input_;  ///< null: there is none
  actuation::ToolLoop loop_;
  AxisReporter reporter_;
  std::vector<actuation::PlannedStop> stops_;
  std::vector<actuation::ProtectedPlant> protected_;
  std::optional<Time> last_cycle_;
  double base_x_m_ = 0.0;
  bool emergency_stop_ = false;
};

}  // namespace
}  // namespace furrow::components

extern "C" void furrow_register(furrow::graph::Registry& registry) {
  registry.add<furrow::components::AxisDriverComponent>("axis_driver");
}
