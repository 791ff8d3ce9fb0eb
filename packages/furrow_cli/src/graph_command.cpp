#include <iostream>

#include "command.hpp"
#include "console.hpp"
#include "furrow_core/file.hpp"
#include "furrow_graph/graph_check.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "graph_picture.hpp"
#include "graph_setup.hpp"
#include "share.hpp"

namespace furrow::cli {
namespace {

struct GraphOptions {
  std::string graph = "weeding";
  std::string deploy;
  std::vector<std::string> settings;
  std::string svg;
};

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "-" : text;
}

int show(const GraphOptions& options) {
  graph::Registry registry = make_registry();
  const PreparedGraph prepared = prepare_graph(options.graph, options.settings);
  const auto connections = graph::check_graph(prepared.spec, registry);
  const auto deployment = graph::load_deployment(
      find_shipped(options.deploy.empty() ? "composed" : options.deploy, "deploy"));
  const auto processes = graph::place_components(prepared.spec, deployment);
  if (!options.svg.empty()) {
    const Status written =
        write_file_atomically(options.svg, graph_picture(prepared.spec, connections, processes));
    if (!written.ok()) {
      std::cerr << "furrow: " << written.error().message << '\n';
      return 1;
    }
    std::cout << "picture: " << options.svg << '\n';
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

void check(const GraphOptions& options) {
  graph::Registry registry = make_registry();
  const PreparedGraph prepared = prepare_graph(options.graph, options.settings);
  const auto connections = graph::check_graph(prepared.spec, registry);
  if (!options.deploy.empty()) {
    (void)graph::place_components(prepared.spec,
                                  graph::load_deployment(find_shipped(options.deploy, "deploy")));
  }
  std::cout << prepared.spec.name << " is well: " << prepared.spec.components.size()
            << " components, " << connections.size() << " topics\n";
}

void add_graph_options(CLI::App* command, GraphOptions& options) {
  command->add_option("graph", options.graph, "graph file, or the name of a shipped one")
      ->capture_default_str();
  command->add_option("--deploy", options.deploy, "deployment to place the components by");
  command->add_option("--set", options.settings, "COMPONENT.KEY=VALUE over the file")->take_all();
}

}  // namespace

void add_graph_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("graph", "Looks at a graph without running it.");
  command->require_subcommand(1);
  auto options = std::make_shared<GraphOptions>();
  CLI::App* check_command = command->add_subcommand(
      "check", "Checks classes, wiring, types, QoS and parameters of a graph.");
  add_graph_options(check_command, *options);
  check_command->callback([options] { check(*options); });
  CLI::App* show_command = command->add_subcommand("show", "Lists who publishes and reads what.");
  add_graph_options(show_command, *options);
  show_command->add_option("--svg", options->svg, "draw it into this file instead");
  show_command->callback([options, &exit_code] { exit_code = show(*options); });
  command->add_subcommand("topics", "Prints the table of topics (docs/reference/topics.md).")
      ->callback([] { std::cout << msgs::topics_markdown(); });
}

}  // namespace furrow::cli
