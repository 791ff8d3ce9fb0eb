#include "furrow_evaluation/nozzle_pattern.hpp"

#include <algorithm>
#include <memory>

#include "furrow_components/conversions.hpp"
#include "furrow_configuration/graph_file.hpp"
#include "furrow_graph/graph_check.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::evaluation {
namespace {

namespace topics = msgs::topics;
using components::CalibratedNozzle;

constexpr double kFirst_m = 1.0;
constexpr double kSpacing_m = 0.45;

/// The points that one axis is to spray: one behind the other, to and fro over its travel, each
/// axis in a lane of its own along the way.
std::vector<Eigen::Vector2d> pattern_of(const geometry::AxisModel& axis, std::size_t index,
                                        int sprays) {
  std::vector<Eigen::Vector2d> points;
  constexpr double kPlaces[] = {0.5, 0.6, 0.45, 0.55, 0.4};
  for (int i = 0; i < sprays; ++i) {
    const double share = kPlaces[static_cast<std::size_t>(i) % std::size(kPlaces)];
    const double q_m = axis.lower_m + share * (axis.upper_m - axis.lower_m);
    const double lane_m = 0.1 * static_cast<double>(index % 4);
    points.emplace_back(kFirst_m + lane_m + kSpacing_m * i, axis.nozzle_position_B(q_m).y());
  }
  return points;
}

double pattern_length_m(int sprays) {
  return kFirst_m + kSpacing_m * (sprays + 1);
}

/// Stands in for tracker and planner: tells the axes where to spray, and measures what they did.
class TestPattern final : public graph::Component {
 public:
  TestPattern(graph::Context& context, const geometry::ToolModel& tool, int sprays,
              components::LandingOffsets& landings)
      : landings_(landings),
        plan_out_(context.output<topics::Plan>()),
        tracks_out_(context.output<topics::Tracks>()),
        heartbeat_out_(context.output<topics::PlannerHeartbeat>()) {
    for (std::size_t i = 0; i < tool.axes.size(); ++i) {
      auto& route = plan_.routes().emplace_back();
      route.axis(tool.axes[i].name);
      for (const Eigen::Vector2d& p_F : pattern_of(tool.axes[i], i, sprays)) {
        auto& stop = route.stops().emplace_back();
        stop.id(++stops_);
        stop.aim(components::to_point(p_F));
        stop.track_ids({stops_});
        // Only the order matters here: the drivers time themselves by the odometry.
        stop.expected(graph::to_msg(Time::from_seconds(p_F.x())));
      }
    }
    context.every(Duration::milliseconds(200), [this](Time now) {
      plan_.header(components::header(now, components::kFieldFrame));
      plan_.revision(plan_.revision() + 1);
      plan_out_.publish(plan_);
      furrow_msgs::msg::Tracks tracks;
      tracks.header(plan_.header());
      tracks_out_.publish(std::move(tracks));
    });
    context.every(Duration::milliseconds(20), [this](Time now) {
      furrow_msgs::msg::Heartbeat beat;
      beat.header(components::header(now, ""));
      heartbeat_out_.publish(std::move(beat));
    });
    context.input<topics::TrueOdometry>(
        [this](const auto& odometry) { speed_mps_ = components::from_msg(*odometry).speed_mps; });
    context.input<topics::TrueSpray>([this](const auto& spray) {
      const Eigen::Vector3d offset =
          components::from_point(spray->centre()) - components::from_point(spray->aim());
      landings_[spray->axis()].push_back({speed_mps_, offset.head<2>()});
    });
    context.input<topics::RunStatus>([&context](const auto& status) {
      if (status->finished()) context.request_stop("finished");
    });
  }

  static void describe(graph::Description& d) {
    d.doc("A test pattern for the nozzles, and where its sprays landed.")
        .input<topics::TrueOdometry>()
        .input<topics::TrueSpray>()
        .input<topics::RunStatus>()
        .output<topics::Plan>()
        .output<topics::Tracks>()
        .output<topics::PlannerHeartbeat>();
  }

 private:
  components::LandingOffsets& landings_;
  graph::Output<topics::Plan> plan_out_;
  graph::Output<topics::Tracks> tracks_out_;
  graph::Output<topics::PlannerHeartbeat> heartbeat_out_;
  furrow_msgs::msg::Plan plan_;
  std::int64_t stops_ = 0;
  double speed_mps_ = 0.0;
};

void set(graph::ComponentSpec& component, const std::string& name, ParameterValue value) {
  std::erase_if(component.parameters, [&](const auto& given) { return given.name == name; });
  component.parameters.push_back({name, std::move(value), component.where});
}

const GivenParameter* find_parameter(const graph::ComponentSpec& component,
                                     const std::string& name) {
  const auto it = std::ranges::find(component.parameters, name, &GivenParameter::name);
  return it == component.parameters.end() ? nullptr : &*it;
}

std::string axis_of(const graph::ComponentSpec& driver) {
  const GivenParameter* axis = find_parameter(driver, "axis");
  return axis == nullptr ? "" : to_text(axis->value);
}

void use_nozzle(graph::ComponentSpec& driver, CalibratedNozzle nozzle) {
  set(driver, "nozzle_file", std::string());
  ParameterLister lister;
  nozzle.calibration.visit(lister);
  for (const DeclaredParameter& entry : lister.declared()) {
    set(driver, "nozzle_" + entry.info.name, entry.default_value);
  }
}

/// Robot and axis drivers as the graph has them, and the pattern in place of the rest.
graph::GraphSpec pattern_graph(const launch::PreparedGraph& prepared,
                               const std::vector<CalibratedNozzle>& nozzles, double speed_mps,
                               double length_m) {
  graph::GraphSpec spec = prepared.spec;
  std::erase_if(spec.components, [](const graph::ComponentSpec& component) {
    return component.class_name != "robot_simulator" && component.class_name != "axis_driver";
  });
  // The other common parameters belong to the components that are left out.
  std::erase_if(spec.common,
                [](const GivenParameter& parameter) { return parameter.name != "tool_file"; });
  bool has_robot = false;
  bool has_driver = false;
  for (graph::ComponentSpec& component : spec.components) {
    if (component.class_name == "robot_simulator") {
      has_robot = true;
      set(component, "speed_mps", speed_mps);
      set(component, "length_m", length_m);
      continue;
    }
    has_driver = true;
    component.remaps["localization/odometry"] = "truth/odometry";
    const auto nozzle = std::ranges::find(nozzles, axis_of(component), &CalibratedNozzle::axis);
    if (nozzle != nozzles.end()) use_nozzle(component, *nozzle);
  }
  if (!has_robot || !has_driver) {
    throw ConfigError(prepared.spec.where, "components",
                      "calibration needs a robot_simulator and an axis_driver");
  }
  spec.components.push_back({.name = "test_pattern",
                             .group = "test_pattern",
                             .class_name = "test_pattern",
                             .where = prepared.spec.where});
  return spec;
}

/// What an axis driver's parameters say of its nozzle; the rest of them does not matter here.
struct NozzleParameters {
  std::string nozzle_file;
  actuation::NozzleCalibration nozzle;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "nozzle_file"}, nozzle_file);
    PrefixedVisitor nozzle_visitor(v, "nozzle_");
    nozzle.visit(nozzle_visitor);
  }
};

}  // namespace

std::vector<CalibratedNozzle> nozzles_of(const launch::PreparedGraph& prepared) {
  std::vector<CalibratedNozzle> nozzles;
  for (const graph::ComponentSpec& component : prepared.spec.components) {
    if (component.class_name != "axis_driver") continue;
    std::vector<GivenParameter> given;
    for (const GivenParameter& parameter : component.parameters) {
      if (parameter.name.starts_with("nozzle_")) given.push_back(parameter);
    }
    NozzleParameters parameters;
    ParameterLoader::load(given, parameters);
    const std::string axis = axis_of(component);
    nozzles.push_back({axis, parameters.nozzle_file.empty()
                                 ? parameters.nozzle
                                 : components::load_nozzle(parameters.nozzle_file, axis)});
  }
  return nozzles;
}

components::LandingOffsets run_pattern(const launch::PreparedGraph& prepared,
                                       const std::vector<CalibratedNozzle>& nozzles,
                                       const PatternOptions& options) {
  const auto tool =
      geometry::load_tool_model(configuration::common_text(prepared.spec, "tool_file"));
  components::LandingOffsets landings;
  for (std::size_t i = 0; i < options.speeds_mps.size(); ++i) {
    graph::Registry registry = launch::make_registry();
    graph::ComponentClass type{.name = "test_pattern"};
    TestPattern::describe(type.description);
    type.make = [&](graph::Context& context) {
      return std::make_unique<TestPattern>(context, tool, options.sprays, landings);
    };
    registry.add(std::move(type));
    const auto spec =
        pattern_graph(prepared, nozzles, options.speeds_mps[i], pattern_length_m(options.sprays));
    graph::Runtime runtime(
        spec, registry,
        {.clock = graph::ClockMode::kLockstep, .threads = 1, .seed = options.seed + i});
    const graph::RunResult result = runtime.run();
    if (result.failed || result.reason != "finished") {
      throw std::runtime_error("the test pattern ended early: " + result.reason);
    }
  }
  return landings;
}

}  // namespace furrow::evaluation
