#include "sensing_log.hpp"

#include <stdexcept>
#include <utility>

#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/topics.hpp"
#include "graph_setup.hpp"
#include "share.hpp"

namespace furrow::cli {
namespace {

namespace topics = msgs::topics;
constexpr char kName[] = "furrow_sensing_log";

struct Collector {
  SensingLog log;
  std::function<void(double)> progress;
};

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

}  // namespace

SensingLog record_sensing(const SensingOptions& options) {
  PreparedGraph prepared = prepare_graph(options.graph, options.settings);
  graph::Registry registry = make_registry();
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
  return std::move(collector->log);
}

}  // namespace furrow::cli
