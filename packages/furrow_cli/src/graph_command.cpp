#include <iostream>
#include <memory>
#include <optional>

#include "commands.hpp"
#include "furrow_configuration/deployment_file.hpp"
#include "furrow_graph/graph_check.hpp"
#include "furrow_launch/graph_picture.hpp"
#include "furrow_launch/graph_setup.hpp"
#include "furrow_launch/installation.hpp"
#include "output_options.hpp"

namespace furrow::cli {
namespace {

struct GraphOptions {
  std::string graph = "weeding";
  std::string deploy;
  std::vector<std::string> settings;
  std::string svg;
  bool force = false;
};

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "-" : text;
}

int show(const GraphOptions& options) {
  std::optional<OutputFile> svg;
  if (!options.svg.empty()) svg = claim_file(options.svg, options.force, "--svg");
  graph::Registry registry = launch::make_registry();
  const launch::PreparedGraph prepared = launch::prepare_graph(options.graph, options.settings);
  const auto connections = graph::check_graph(prepared.spec, registry);
  const auto deployment = configuration::load_deployment(
      launch::find_shipped(options.deploy.empty() ? "composed" : options.deploy, "deploy"));
  const auto processes = configuration::place_components(prepared.spec, deployment);
  if (svg) {
    write_or_throw(*svg, launch::graph_picture(prepared.spec, connections, processes));
    std::cout << "picture: " << svg->path().string() << '\n';
    return 0;
  }
  if (!options.deploy.empty()) {
    for (const auto& process : processes) {
      std::cout << "process " << process.name << (process.host.empty() ? "" : " on " + process.host)
                << ": " << joined(process.components) << '\n';
    }
  }
  std::cout << prepared.spec.name << ": " << prepared.spec.components.size() << " components, "
            << connections.size() << " topics\n";
  for (const graph::Connection& connection : connections) {
    std::cout << "  " << connection.topic << "  [" << connection.type->ros_name << "]\n      from "
              << joined(connection.publishers) << "\n      to   " << joined(connection.readers)
              << '\n';
  }
  return 0;
}

int check(const GraphOptions& options) {
  graph::Registry registry = launch::make_registry();
  const launch::PreparedGraph prepared = launch::prepare_graph(options.graph, options.settings);
  const auto connections = graph::check_graph(prepared.spec, registry);
  if (!options.deploy.empty()) {
    (void)configuration::place_components(
        prepared.spec,
        configuration::load_deployment(launch::find_shipped(options.deploy, "deploy")));
  }
  std::cout << prepared.spec.name << " is well: " << prepared.spec.components.size()
            << " components, " << connections.size() << " topics\n";
  return 0;
}

void add_graph_options(Command command, GraphOptions& options) {
  command.option("graph", options.graph, "graph file, or the name of a shipped graph");
  command.option("--deploy", options.deploy, "deployment that places the components");
  command.option("--set", options.settings, "COMPONENT.KEY=VALUE overrides a parameter");
}

}  // namespace

void add_graph_commands(Command root) {
  Command group = root.group("graph", "Inspects a graph without running it.");
  auto options = std::make_shared<GraphOptions>();
  Command check_command =
      group.subcommand("check", "Checks classes, wiring, types, QoS and parameters of a graph.");
  add_graph_options(check_command, *options);
  check_command.on_run([options] { return check(*options); });
  Command show_command =
      group.subcommand("show", "Lists publishers and subscribers of each topic.");
  add_graph_options(show_command, *options);
  show_command.option("--svg", options->svg, "draw the graph into this file instead");
  add_force_option(show_command, options->force);
  show_command.on_run([options] { return show(*options); });
  group.subcommand("topics", "Prints the table of topics (docs/reference/topics.md).").on_run([] {
    std::cout << msgs::topics_markdown();
    return 0;
  });
}

}  // namespace furrow::cli
