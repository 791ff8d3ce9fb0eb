#include "furrow_configuration/graph_file.hpp"

#include <gtest/gtest.h>

#include "furrow_configuration/deployment_file.hpp"
#include "furrow_core/test_support/config_error.hpp"
#include "furrow_core/test_support/temporary_folder.hpp"

namespace furrow::configuration {
namespace {

constexpr char kGraph[] = R"(graph: example
common: {rate_hz: 5, tool_file: tool.urdf}
components:
  source: {class: source, parameters_file: source.yaml, parameters: {label: b}}
  axis:
    class: relay
    for_each: axes
    parameter: axis
    remap: {tracker/tracks: truth/tracks}
)";

class GraphFile : public testing::Test {
 protected:
  graph::GraphSpec load(const std::string& text) {
    return load_graph(write_text(folder_ / "g.yaml", text));
  }
  std::string error(const std::string& text) {
    return error_of(folder_, [&] { (void)load(text); });
  }
  TemporaryFolder temporary_;
  const std::filesystem::path& folder_ = temporary_.path();
};

TEST_F(GraphFile, LoadsComponentsWithTheirSettings) {
  write_text(folder_ / "source.yaml", "label: a\nrate_hz: 3\n");
  graph::GraphSpec graph = load(kGraph);
  EXPECT_EQ(graph.name, "example");
  EXPECT_EQ(common_text(graph, "tool_file"), (folder_ / "tool.urdf").string());
  ASSERT_EQ(graph.components.size(), 2u);
  ASSERT_EQ(graph.components[0].parameters.size(), 2u);
  EXPECT_EQ(graph.components[0].parameters[0].value, ParameterValue(std::string("b")));

  expand_lists(graph, {{"axes", {"one", "two"}}});
  ASSERT_EQ(graph.components.size(), 3u);
  EXPECT_EQ(graph.components[2].name, "axis_two");
  EXPECT_EQ(graph.components[2].group, "axis");
  EXPECT_EQ(graph.components[2].parameters[0].value, ParameterValue(std::string("two")));
  EXPECT_EQ(graph.components[2].remaps.at("tracker/tracks"), "truth/tracks");
}

TEST_F(GraphFile, ReadsThreadAndPriorityOfAComponent) {
  const graph::GraphSpec graph = load(
      "components:\n"
      "  a: {class: b}\n"
      "  c: {class: b, thread: dedicated}\n"
      "  d: {class: b, thread: dedicated, priority: 60}\n"
      "  e: {class: b, thread: pool}\n");
  ASSERT_EQ(graph.components.size(), 4u);
  EXPECT_FALSE(graph.components[0].dedicated_thread);
  EXPECT_TRUE(graph.components[1].dedicated_thread);
  EXPECT_EQ(graph.components[1].priority, 0);
  EXPECT_EQ(graph.components[2].priority, 60);
  EXPECT_FALSE(graph.components[3].dedicated_thread);

  EXPECT_EQ(error("components:\n  a: {class: b, thread: own}\n"),
            "g.yaml:2: a.thread: must be dedicated or pool");
  EXPECT_EQ(error("components:\n  a: {class: b, priority: 60}\n"),
            "g.yaml:2: a.priority: requires thread: dedicated");
  for (const std::string priority : {"100", "-1", "high", "1.5"}) {
    EXPECT_EQ(
        error("components:\n  a: {class: b, thread: dedicated, priority: " + priority + "}\n"),
        "g.yaml:2: a.priority: must be a number from 0 to 99");
  }
}

TEST_F(GraphFile, AnErrorNamesFileLineAndKey) {
  EXPECT_EQ(error("graph: g\n"), "g.yaml:1: components: is missing or empty");
  EXPECT_EQ(error("graph: g\ncomponent: {}\n"),
            "g.yaml:2: component: unknown key; known: graph, common, external, components");
  EXPECT_EQ(error("components:\n  a: {clas: b}\n"),
            "g.yaml:2: a.clas: unknown key; known: class, library, parameters_file, parameters, "
            "remap, for_each, parameter, thread, priority");
  EXPECT_EQ(error("components:\n  a: {remap: {}}\n"), "g.yaml:2: a.class: is missing");
  EXPECT_EQ(error("components:\n  A: {class: b}\n"),
            "g.yaml:2: A: is not a component's name (lower-case letters, digits and _; not "
            "'common')");
  EXPECT_EQ(error("components:\n  a: {class: b, for_each: axes}\n"),
            "g.yaml:2: a: for_each requires parameter, and parameter requires for_each");
  EXPECT_EQ(error("components:\n  a: {class: b, parameters: 3}\n"),
            "g.yaml:2: parameters: is not a map of keys");
}

TEST_F(GraphFile, AnUnknownListIsAnError) {
  graph::GraphSpec graph = load("components:\n  a: {class: b, for_each: wheels, parameter: w}\n");
  EXPECT_EQ(error_of(folder_, [&] { expand_lists(graph, {}); }),
            "g.yaml:2: a.for_each: there is no list 'wheels'");
}

TEST_F(GraphFile, SettingsOverrideTheFile) {
  graph::GraphSpec graph = load(
      "components:\n  a: {class: b, parameters: {x: 1}}\n"
      "  axis: {class: c, for_each: axes, parameter: axis}\n");
  expand_lists(graph, {{"axes", {"one", "two"}}});
  apply_settings(graph, {"a.x=2", "axis.y=true", "axis_two.y=false", "common.seed=4"});
  EXPECT_EQ(graph.components[0].parameters[0].value, ParameterValue(std::int64_t{2}));
  EXPECT_EQ(graph.components[1].parameters[1].value, ParameterValue(true));
  EXPECT_EQ(graph.components[2].parameters[1].value, ParameterValue(false));
  EXPECT_EQ(common_text(graph, "seed"), "4");
  EXPECT_EQ(error_of(folder_, [&] { apply_settings(graph, {"other.x=1"}); }),
            "--set other.x=1: other: the graph has no such component");
  EXPECT_EQ(error_of(folder_, [&] { apply_settings(graph, {"a"}); }),
            "--set a: is not COMPONENT.KEY=VALUE");
}

TEST_F(GraphFile, DeploymentPlacesEveryComponentOnce) {
  const graph::GraphSpec graph =
      load("components:\n  a: {class: x}\n  b: {class: x}\n  c: {class: x}\n");
  const auto place = [&](const std::string& text) {
    return place_components(graph, load_deployment(write_text(folder_ / "d.yaml", text)));
  };
  EXPECT_EQ(place("processes: {all: \"*\"}\n").at(0).components.size(), 3u);
  const auto two = place("processes:\n  one: [c, a]\n  two: {host: h, components: [b]}\n");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0].components, (std::vector<std::string>{"a", "c"}));
  EXPECT_EQ(two[1].host, "h");

  const auto error = [&](const std::string& text) {
    return error_of(folder_, [&] { (void)place(text); });
  };
  EXPECT_EQ(error("processes: {one: [a, b]}\n"),
            "d.yaml:1: processes: component 'c' is in no process");
  EXPECT_EQ(error("processes:\n  one: [a, b, c]\n  two: [a]\n"),
            "d.yaml:3: two: component 'a' is already in process 'one'");
  EXPECT_EQ(error("processes:\n  one: [z]\n"), "d.yaml:2: one: the graph has no component 'z'");
  EXPECT_EQ(error("deployment: d\n"), "d.yaml:1: processes: is missing or empty");
  EXPECT_EQ(error("process: d\n"),
            "d.yaml:1: process: unknown key; known: deployment, hosts, processes, wire");
  EXPECT_EQ(error("processes:\n  one: {components: [a], each: maybe}\n"),
            "d.yaml:2: one.each: must be true or false");
}

TEST_F(GraphFile, RemainingComponentsMayHaveAProcessEach) {
  const graph::GraphSpec graph =
      load("components:\n  a: {class: x}\n  b: {class: x}\n  c: {class: x}\n");
  const auto place = [&](const std::string& text) {
    return place_components(graph, load_deployment(write_text(folder_ / "d.yaml", text)));
  };
  const auto placed = place(
      "processes:\n  others: {components: \"*\", each: true}\n"
      "  mine: {components: [b, \"z?\"], restart: false}\n  nobody: [\"y?\"]\n");
  ASSERT_EQ(placed.size(), 3u);
  EXPECT_EQ(placed[0].name, "a");
  EXPECT_EQ(placed[1].name, "c");
  EXPECT_TRUE(placed[1].restart);
  EXPECT_EQ(placed[2].name, "mine");
  EXPECT_EQ(placed[2].components, std::vector<std::string>{"b"});
  EXPECT_FALSE(placed[2].restart);
  EXPECT_EQ(
      error_of(folder_,
               [&] {
                 (void)place("processes:\n  b: [a]\n  others: {components: \"*\", each: true}\n");
               }),
      "d.yaml:1: processes: process 'b' is given twice");
}

TEST_F(GraphFile, HostAddressesBecomeTransportParameters) {
  const std::string text =
      "hosts: {one: 10.0.0.1, two: 10.0.0.2, three: 10.0.0.3}\n"
      "processes: {p: {host: two, components: \"*\"}}\n";
  const auto load_with = [&](const std::vector<std::string>& settings) {
    DeploymentSpec deployment = load_deployment(write_text(folder_ / "d.yaml", text));
    apply_addresses(deployment, {"three=10.0.0.9"});
    apply_transport_settings(deployment, settings);
    std::map<std::string, std::string> values;
    for (const GivenParameter& parameter : transport_parameters(deployment, "two")) {
      values[parameter.name] = to_text(parameter.value);
    }
    return values;
  };
  using Values = std::map<std::string, std::string>;
  EXPECT_EQ(load_with({}), (Values{{"interfaces", "[10.0.0.2]"}}));
  EXPECT_EQ(load_with({"discovery=static_peers"}), (Values{{"interfaces", "[10.0.0.2]"},
                                                           {"discovery", "static_peers"},
                                                           {"peers", "[10.0.0.1, 10.0.0.9]"}}));
  EXPECT_EQ(load_with({"discovery=discovery_server", "interfaces=[10.1.1.1]"}),
            (Values{{"interfaces", "[10.1.1.1]"},
                    {"discovery", "discovery_server"},
                    {"peers", "[10.0.0.1]"}}));
  DeploymentSpec deployment = load_deployment(write_text(folder_ / "d.yaml", text));
  EXPECT_EQ(error_of(folder_, [&] { apply_addresses(deployment, {"four=10.0.0.4"}); }),
            "--address four=10.0.0.4: is not HOST=ADDRESS with a host of the deployment");
  EXPECT_EQ(error_of(folder_, [&] { apply_transport_settings(deployment, {"domain_id"}); }),
            "--wire domain_id: is not KEY=VALUE");
  EXPECT_EQ(error_of(folder_,
                     [&] {
                       (void)load_deployment(write_text(
                           folder_ / "d.yaml", "hosts: {h: 10.0.0.1}\nprocesses: {p: \"*\"}\n"));
                     }),
            "d.yaml:2: p.host: '' is not one of the hosts");
}

}  // namespace
}  // namespace furrow::configuration
