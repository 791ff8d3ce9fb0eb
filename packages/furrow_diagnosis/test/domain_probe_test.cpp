#include "furrow_diagnosis/domain_probe.hpp"

#include <gtest/gtest.h>

#include "furrow_msgs/topics.hpp"

namespace furrow::diagnosis {
namespace {

namespace topics = msgs::topics;

struct PerceptionParameters {
  bool use_depth = true;
  double depth_unit_m = 0.001;
  double ground_distance_m = 1.0;
  void visit(ParameterVisitor& v) {
    v.visit({.name = "use_depth"}, use_depth);
    v.visit({.name = "depth_unit_m", .unit = "m"}, depth_unit_m);
    v.visit({.name = "ground_distance_m", .unit = "m"}, ground_distance_m);
  }
};

graph::Registry registry_of_robot() {
  graph::Registry registry;
  graph::ComponentClass perception{.name = "perception"};
  perception.description.parameters<PerceptionParameters>()
      .input<topics::GnssFix>()
      .input<topics::CameraImage>()
      .input<topics::CameraDepth>(graph::Need::kOptional);
  registry.add(std::move(perception));
  return registry;
}

SensorSetup setup_with(const std::vector<GivenParameter>& parameters) {
  graph::Registry registry = registry_of_robot();
  graph::GraphSpec graph;
  graph.external = {"camera/depth"};
  graph::ComponentSpec eyes{.name = "eyes", .group = "eyes", .class_name = "perception"};
  eyes.parameters = parameters;
  eyes.remaps = {{"camera/image", "front/color"}};
  graph.components = {eyes};
  return sensor_setup(graph, {}, registry);
}

TEST(SensorSetup, HasTheInputsInTheOrderOfTheirRoles) {
  const SensorSetup setup = setup_with({});
  ASSERT_EQ(setup.inputs.size(), 3U);
  EXPECT_EQ(setup.inputs[0].input.topic, "front/color");
  EXPECT_EQ(setup.inputs[0].role, Role::kImage);
  EXPECT_EQ(setup.inputs[1].role, Role::kDepth);
  EXPECT_EQ(setup.inputs[2].role, Role::kGnss);
  EXPECT_FALSE(setup.expectation.camera);
}

TEST(SensorSetup, FollowsTheParametersOfPerception) {
  const SensorSetup setup = setup_with({{"use_depth", false, {}},
                                        {"depth_unit_m", 1e-4, {}},
                                        {"ground_distance_m", std::int64_t{2}, {}}});
  EXPECT_EQ(setup.inputs.size(), 2U);
  EXPECT_EQ(setup.expectation.depth_unit_m, 1e-4);
  EXPECT_EQ(setup.expectation.ground_distance_m, 2.0);
}

dds::DiscoverySnapshot domain_with(const std::string& topic, const dds::EndpointInfo& writer) {
  dds::DiscoverySnapshot domain;
  domain.processes = {{.guid = {}, .name = "driver", .host = "cam1"}};
  domain.topics = {{.name = topic, .type_names = {writer.type_name}, .writers = {writer}}};
  return domain;
}

TopicObservation observed(const dds::DiscoverySnapshot& domain) {
  const SensorSetup setup = setup_with({});
  TopicObservation topic;
  add_writers(topic, setup.inputs[0].input, setup.inputs, domain);
  return topic;
}

dds::EndpointInfo image_writer() {
  dds::EndpointInfo writer;
  writer.type_name = "sensor_msgs::msg::dds_::Image_";
  return writer;
}

TEST(DomainProbe, NamesProcessAndTypeOfAWriter) {
  dds::EndpointInfo writer = image_writer();
  writer.type_name = "sensor_msgs::msg::dds_::CompressedImage_";
  const TopicObservation topic = observed(domain_with("front/color", writer));
  ASSERT_EQ(topic.writers.size(), 1U);
  EXPECT_EQ(topic.writers[0].process, "driver on cam1");
  EXPECT_EQ(topic.writers[0].type, "sensor_msgs/msg/CompressedImage");
  EXPECT_EQ(topic.writers[0].incompatibility, "");
}

TEST(DomainProbe, AcceptsABestEffortWriterOfASensor) {
  dds::EndpointInfo writer = image_writer();
  writer.qos.reliability = msgs::Reliability::kBestEffort;
  EXPECT_EQ(observed(domain_with("front/color", writer)).writers.at(0).incompatibility, "");
}

TEST(DomainProbe, NamesBothQosOfAnIncompatibleWriter) {
  SensorSetup setup = setup_with({});
  setup.inputs[0].input.qos.durability = msgs::Durability::kTransientLocal;
  TopicObservation topic;
  add_writers(topic, setup.inputs[0].input, setup.inputs,
              domain_with("front/color", image_writer()));
  EXPECT_EQ(topic.writers.at(0).incompatibility,
            "durability: offered volatile, requested transient local");
}

TEST(DomainProbe, OffersOtherTopicsOfTheTypeThatNoInputUses) {
  EXPECT_EQ(observed(domain_with("camera/color/image_raw", image_writer())).alternatives,
            std::vector<std::string>{"camera/color/image_raw"});
  EXPECT_TRUE(observed(domain_with("camera/depth", image_writer())).alternatives.empty());
  EXPECT_EQ(observed(domain_with("//front/color", image_writer())).alternatives,
            std::vector<std::string>{"//front/color"});
}

TEST(DomainProbe, LeavesItsOwnEndpointsOut) {
  dds::EndpointInfo writer = image_writer();
  writer.own = true;
  EXPECT_TRUE(observed(domain_with("front/color", writer)).writers.empty());
  EXPECT_TRUE(observed(domain_with("other", writer)).alternatives.empty());
}

}  // namespace
}  // namespace furrow::diagnosis
