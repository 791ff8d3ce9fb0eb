#include "furrow_launch/graph_setup.hpp"

#include <map>

#include "furrow_configuration/graph_file.hpp"
#include "furrow_launch/installation.hpp"

namespace furrow::launch {

PreparedGraph prepare_graph(const std::string& graph, const std::vector<std::string>& settings) {
  PreparedGraph prepared;
  prepared.spec = configuration::load_graph(find_shipped(graph, "graph"));
  // The tool decides how many axis drivers there are, so that its setting must come first.
  std::vector<std::string> common;
  std::vector<std::string> others;
  for (const std::string& setting : settings) {
    (setting.starts_with("common.") ? common : others).push_back(setting);
  }
  configuration::apply_settings(prepared.spec, common);
  const std::string tool = configuration::common_text(prepared.spec, "tool_file");
  if (!tool.empty()) {
    prepared.tool = geometry::load_tool_model(tool);
    for (const geometry::AxisModel& axis : prepared.tool.axes) {
      prepared.axes.push_back(axis.name);
    }
  }
  std::map<std::string, std::vector<std::string>> lists;
  if (!prepared.axes.empty()) lists["axes"] = prepared.axes;
  configuration::expand_lists(prepared.spec, lists);
  configuration::apply_settings(prepared.spec, others);
  return prepared;
}

}  // namespace furrow::launch
