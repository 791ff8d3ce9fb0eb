#include "wire_options.hpp"

#include "furrow_graph/graph_file.hpp"

namespace furrow::cli {

void add_wire_options(CLI::App& command, WireOptions& options) {
  command.add_option("--domain", options.domain_id, "DDS domain")
      ->check(CLI::Range(0, 232))
      ->capture_default_str();
  command.add_option("--wire", options.settings, "KEY=VALUE of the transport's parameters")
      ->take_all();
}

dds::DdsParameters wire_parameters(const WireOptions& options, const std::string& process_name) {
  graph::DeploymentSpec deployment;
  graph::apply_wire_settings(deployment, options.settings);
  dds::DdsParameters parameters;
  parameters.domain_id = options.domain_id;
  parameters.process_name = process_name;
  ParameterLoader::load(deployment.wire, parameters);
  return parameters;
}

}  // namespace furrow::cli
