#include "furrow_evaluation/sensing_log.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "furrow_components/field_conversion.hpp"
#include "furrow_configuration/graph_file.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_launch/graph_setup.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::evaluation {
namespace {

namespace topics = msgs::topics;
constexpr char kName[] = "furrow_sensing_log";

/// One plant in the ground truth of one image.
struct ShownPlant {
  Time stamp;
  Eigen::Vector3d p_C_m = Eigen::Vector3d::Zero();
  std::int64_t visible_px = 0;
};

struct Collector {
  SensingLog log;
  std::vector<ShownPlant> shown;
  std::function<void(double)> progress;
};

std::int64_t pixels_of(const furrow_msgs::msg::PlantInstance& instance) {
  std::int64_t pixels = 0;
  for (std::size_t i = 1; i < instance.mask_runs().size(); i += 2) {
    pixels += instance.mask_runs()[i];
  }
  return pixels;
}

void add_collector(const std::shared_ptr<Collector>& collector, graph::GraphSpec& graph,
                   graph::Registry& registry) {
  graph::ComponentClass type;
  type.name = kName;
  type.description.doc("Keeps what sensors and detector tell.")
      .input<topics::WheelOdometry>()
      .input<topics::Imu>()
      .input<topics::GnssFix>()
      .input<topics::Instances>()
      .input<topics::TrueOdometry>()
      .input<topics::TrueField>()
      .input<topics::TrueInstances>()
      .input<topics::RunStatus>();
  type.make = [collector](graph::Context& context) {
    const auto keep = [collector](const auto& message) {
      collector->log.events.push_back(message);
    };
    context.input<topics::WheelOdometry>(keep);
    context.input<topics::Imu>(keep);
    context.input<topics::GnssFix>(keep);
    context.input<topics::Instances>(keep);
    context.input<topics::TrueOdometry>([collector](const auto& message) {
      collector->log.truth.push_back(components::from_msg(*message));
    });
    context.input<topics::TrueField>([collector](const auto& message) {
      collector->log.field = components::from_msg(*message);
    });
    context.input<topics::TrueInstances>([collector](const auto& message) {
      const Time stamp = graph::from_msg(message->header().stamp());
      for (const auto& instance : message->instances()) {
        const auto& p_C = instance.stem();
        if (const std::int64_t pixels = pixels_of(instance); pixels > 0) {
          collector->shown.push_back({stamp, {p_C.x(), p_C.y(), p_C.z()}, pixels});
        }
      }
    });
    context.input<topics::RunStatus>([collector, &context](const auto& status) {
      if (collector->progress) collector->progress(status->progress());
      if (status->finished()) context.request_stop("finished");
    });
    return std::make_unique<graph::Component>();
  };
  registry.add(std::move(type));
  graph.components.push_back(
      {.name = kName, .group = kName, .class_name = kName, .where = graph.where});
}

/// The ground truth of an image says where a plant stands, not which plant it is. No two plants
/// stand in one place.
void count_visible(const std::vector<ShownPlant>& shown, const Eigen::Isometry3d& X_BC,
                   SensingLog& log) {
  constexpr double kSamePlace_m = 1e-4;
  const auto& plants = log.field.plants;
  const auto x_of = [](const field::Plant& plant) { return plant.p_F_m.x(); };
  log.most_visible_px.assign(plants.size(), 0);
  for (const ShownPlant& one : shown) {
    const auto base =
        std::ranges::lower_bound(log.truth, one.stamp, {}, &components::BaseOdometry::stamp);
    if (base == log.truth.end()) continue;
    const Eigen::Vector2d p_F = (geometry::to_isometry(base->X_FB) * X_BC * one.p_C_m).head<2>();
    for (auto plant = std::ranges::lower_bound(plants, p_F.x() - kSamePlace_m, {}, x_of);
         plant != plants.end() && plant->p_F_m.x() < p_F.x() + kSamePlace_m; ++plant) {
      if ((plant->p_F_m - p_F).norm() > kSamePlace_m) continue;
      auto& most = log.most_visible_px[static_cast<std::size_t>(plant - plants.begin())];
      most = std::max(most, one.visible_px);
    }
  }
}

}  // namespace

SensingLog record_sensing(const SensingOptions& options) {
  launch::PreparedGraph prepared = launch::prepare_graph(options.graph, options.settings);
  const geometry::ToolModel tool =
      geometry::load_tool_model(configuration::common_text(prepared.spec, "tool_file"));
  if (tool.cameras.empty()) throw ConfigError("the tool has no camera");
  graph::Registry registry = launch::make_registry();
  const auto collector = std::make_shared<Collector>();
  collector->progress = options.progress;
  add_collector(collector, prepared.spec, registry);
  graph::Runtime runtime(prepared.spec, registry,
                         {.clock = graph::ClockMode::kLockstep,
                          .threads = options.threads,
                          .seed = options.seed,
                          .components = {},
                          .transport = nullptr});
  const graph::RunResult result = runtime.run();
  if (result.failed || result.reason != "finished") {
    throw std::runtime_error("the run ended early: " + result.reason);
  }
  count_visible(collector->shown, tool.cameras.front().X_BC, collector->log);
  return std::move(collector->log);
}

}  // namespace furrow::evaluation
