#include "furrow_graph/graph_check.hpp"

#include "fixtures.hpp"
#include "furrow_core/test_support/config_error.hpp"

namespace furrow::graph {
namespace {

using test::spec;

std::string error(const GraphSpec& graph) {
  Registry registry = test::standard_registry();
  return error_of("", [&] { check_graph(graph, registry); });
}

TEST(GraphCheck, ListsConnectionsByTopic) {
  Registry registry = test::standard_registry();
  GraphSpec graph;
  graph.components = {spec("s", "source"), spec("r", "relay")};
  const auto connections = check_graph(graph, registry);
  ASSERT_EQ(connections.size(), 2u);
  EXPECT_EQ(connections[1].topic, "tracker/tracks");
  EXPECT_EQ(connections[1].publishers, std::vector<std::string>{"s"});
  EXPECT_EQ(connections[1].readers, std::vector<std::string>{"r"});
}

TEST(GraphCheck, AnUnknownClassIsAnError) {
  GraphSpec graph;
  graph.components = {spec("s", "sauce")};
  EXPECT_EQ(error(graph),
            "graph.yaml:1: class: unknown component class 'sauce'; looked for "
            "libfurrow_component_sauce.so in: (no folder)");
}

TEST(GraphCheck, AnUnconnectedInputIsAnError) {
  GraphSpec graph;
  graph.components = {spec("r", "relay")};
  EXPECT_EQ(error(graph),
            "graph.yaml:1: r: input 'tracker/tracks' is not connected: no component publishes "
            "'tracker/tracks'");
  graph.external = {"tracker/tracks"};
  EXPECT_EQ(error(graph), "");
}

TEST(GraphCheck, ATypeMismatchIsAnError) {
  GraphSpec graph;
  graph.components = {spec("s", "source"), spec("r", "relay")};
  graph.components[1].remaps = {{"planner/plan", "tracker/tracks"}};
  EXPECT_EQ(error(graph),
            "graph.yaml:1: r: topic 'tracker/tracks' carries furrow_msgs/msg/Tracks, but port "
            "'planner/plan' has type furrow_msgs/msg/Plan");
}

TEST(GraphCheck, ARemapOfAnUnknownPortIsAnError) {
  GraphSpec graph;
  graph.components = {spec("s", "source")};
  graph.components[0].remaps = {{"a", "b"}};
  EXPECT_EQ(error(graph), "graph.yaml:1: s.remap.a: class 'source' has no such port");
}

TEST(GraphCheck, ABadParameterIsAnError) {
  GraphSpec graph;
  graph.components = {spec("s", "source")};
  graph.components[0].parameters = {{"rate_h", 3.0, {"graph.yaml", 7}}};
  EXPECT_EQ(error(graph),
            "graph.yaml:7: rate_h: unknown parameter; did you mean 'rate_hz'? (component 's', "
            "class 'source')");
  graph.components[0].parameters = {{"rate_hz", 3e6, {"graph.yaml", 7}}};
  EXPECT_EQ(error(graph),
            "graph.yaml:7: rate_hz: 3000000 is out of range [0.1, 1000] Hz (component 's', class "
            "'source')");
}

TEST(GraphCheck, CommonParametersGoToComponentsThatDeclareThem) {
  GraphSpec graph;
  graph.components = {spec("s", "source"), spec("r", "relay")};
  graph.common = {{"rate_hz", 3.0, {}}};
  EXPECT_EQ(error(graph), "");
  graph.common = {{"rate_kz", 3.0, {"graph.yaml", 2}}};
  EXPECT_EQ(error(graph), "graph.yaml:2: common.rate_kz: no component declares this parameter");
}

/// Declares one parameter that all components must agree on.
struct OriginParameters {
  double latitude_deg = 50.0;
  void visit(ParameterVisitor& v) { v.visit({.name = "latitude_deg"}, latitude_deg); }
};

std::string error_with_origins(const GraphSpec& graph) {
  Registry registry;
  for (const char* name : {"localization", "scorer"}) {
    ComponentClass type{.name = name};
    type.description.parameters<OriginParameters>().shared_parameters({"latitude_deg"});
    type.make = [](Context&) { return std::make_unique<Component>(); };
    registry.add(std::move(type));
  }
  return error_of("", [&] { check_graph(graph, registry); });
}

TEST(GraphCheck, SharedParameterMustBeTheSameInAllComponents) {
  GraphSpec graph;
  graph.components = {spec("localization", "localization"), spec("scorer", "scorer")};
  EXPECT_EQ(error_with_origins(graph), "");
  graph.components[0].parameters = {{"latitude_deg", 48.0, {"graph.yaml", 7}}};
  EXPECT_EQ(error_with_origins(graph),
            "graph.yaml:7: localization.latitude_deg: 48 contradicts scorer.latitude_deg, which is "
            "50 by default; set common.latitude_deg instead");
  graph.components[1].parameters = {{"latitude_deg", 49.0, {"graph.yaml", 9}}};
  EXPECT_EQ(error_with_origins(graph),
            "graph.yaml:9: scorer.latitude_deg: 49 contradicts localization.latitude_deg, which is "
            "48; set common.latitude_deg instead");
  graph.components[1].parameters = {{"latitude_deg", std::int64_t{48}, {"graph.yaml", 9}}};
  EXPECT_EQ(error_with_origins(graph), "");
}

TEST(GraphCheck, CommonValueOfASharedParameterContradictsNothing) {
  GraphSpec graph;
  graph.components = {spec("localization", "localization"), spec("scorer", "scorer")};
  graph.common = {{"latitude_deg", 48.0, {"graph.yaml", 2}}};
  EXPECT_EQ(error_with_origins(graph), "");
  graph.components[1].parameters = {{"latitude_deg", 49.0, {"graph.yaml", 9}}};
  EXPECT_EQ(error_with_origins(graph),
            "graph.yaml:9: scorer.latitude_deg: 49 contradicts localization.latitude_deg, which is "
            "48; set common.latitude_deg instead");
}

TEST(GraphCheck, AnIncompatibleQosNamesThePolicy) {
  // The reader of a latched topic would never get the messages of an earlier writer.
  Registry registry = test::standard_registry();
  ComponentClass reader{.name = "reader"};
  reader.description.input<msgs::topics::RobotDescription>();
  reader.make = [](Context&) { return std::make_unique<Component>(); };
  registry.add(std::move(reader));
  ComponentClass writer{.name = "writer"};
  static const msgs::Topic plain{
      "text", &msgs::message_type<std_msgs::msg::String>(), msgs::reliable_stream_qos(), 0, "", ""};
  struct Text {
    static const msgs::Topic& topic() { return plain; }
  };
  writer.description.output<Text>();
  writer.make = [](Context&) { return std::make_unique<Component>(); };
  registry.add(std::move(writer));
  GraphSpec graph;
  graph.components = {spec("w", "writer"), spec("r", "reader")};
  graph.components[1].remaps = {{"robot_description", "text"}};
  EXPECT_EQ(
      error_of("", [&] { check_graph(graph, registry); }),
      "graph.yaml:1: r: topic 'text': incompatible QoS: durability: offered volatile, requested "
      "transient local");
}

}  // namespace
}  // namespace furrow::graph
