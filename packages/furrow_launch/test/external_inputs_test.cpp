#include "furrow_launch/external_inputs.hpp"

#include <gtest/gtest.h>

#include "furrow_msgs/topics.hpp"

namespace furrow::launch {
namespace {

namespace topics = msgs::topics;

/// Reads the camera and the GNSS, listens to commands, and publishes odometry.
graph::Registry registry_with_reader() {
  graph::Registry registry;
  graph::ComponentClass reader{.name = "reader"};
  reader.description.input<topics::CameraImage>()
      .input<topics::GnssFix>(graph::Need::kOptional)
      .input<topics::Imu>(graph::Need::kOptional)
      .input<topics::EmergencyStop>(graph::Need::kOptional)
      .input<topics::RobotOdometry>()
      .output<topics::RobotOdometry>();
  registry.add(std::move(reader));
  return registry;
}

std::vector<ExternalInput> inputs_of(const std::map<std::string, std::string>& remaps = {}) {
  graph::Registry registry = registry_with_reader();
  graph::GraphSpec graph;
  graph.external = {"camera/image", "gnss/fix", "emergency_stop"};
  graph.components = {{.name = "eyes", .group = "eyes", .class_name = "reader", .remaps = remaps}};
  return external_inputs(graph, registry);
}

dds::EndpointStatus reader_of(const std::string& topic, std::uint64_t messages, int peers) {
  dds::EndpointStatus status;
  status.topic = topic;
  status.counters.messages = messages;
  status.peers = peers;
  return status;
}

/// The warning of the third look: the first two are silent.
std::string warning(const std::vector<dds::EndpointStatus>& endpoints,
                    const dds::DiscoverySnapshot& domain = {}) {
  InputWatch watch(inputs_of());
  EXPECT_EQ(watch.look(endpoints, domain).level, graph::HealthLevel::kOk);
  EXPECT_EQ(watch.look(endpoints, domain).level, graph::HealthLevel::kOk);
  return watch.look(endpoints, domain).message;
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ExternalInputs, AreThoseThatNoComponentPublishesAndThatHaveARate) {
  const auto inputs = inputs_of();
  ASSERT_EQ(inputs.size(), 2U) << "an operator's command and an unnamed option are not expected";
  EXPECT_EQ(inputs[0].topic, "camera/image");
  EXPECT_TRUE(inputs[0].required);
  EXPECT_EQ(inputs[0].readers, std::vector<std::string>{"eyes"});
  EXPECT_EQ(inputs[0].ros_type, "sensor_msgs/msg/Image");
  EXPECT_EQ(inputs[1].topic, "gnss/fix");
  EXPECT_FALSE(inputs[1].required);
}

TEST(ExternalInputs, HaveTheNameThatTheGraphGivesThem) {
  const ExternalInput input = inputs_of({{"camera/image", "front/color"}}).at(0);
  EXPECT_EQ(input.topic, "front/color");
  EXPECT_EQ(input.port, "camera/image");
  EXPECT_TRUE(input.qos.accept_best_effort);
}

TEST(InputWatch, NamesWhatIsNotHeardAndItsEffect) {
  const std::string text = warning({reader_of("camera/image", 0, 0), reader_of("gnss/fix", 0, 0)});
  EXPECT_TRUE(holds(text, "camera/image: no writer was found")) << text;
  EXPECT_TRUE(holds(text, "eyes cannot work without it")) << text;
  EXPECT_TRUE(holds(text, "gnss/fix: no writer was found")) << text;
  EXPECT_TRUE(holds(text, "eyes works without it")) << text;
}

TEST(InputWatch, IsSilentOnInputsThatAreHeard) {
  EXPECT_EQ(warning({reader_of("camera/image", 1, 1), reader_of("gnss/fix", 3, 1)}), "");
}

TEST(InputWatch, TellsASilentWriterFromNone) {
  const std::string text = warning({reader_of("camera/image", 0, 1), reader_of("gnss/fix", 1, 1)});
  EXPECT_TRUE(holds(text, "camera/image: a writer was found, but no message arrived")) << text;
  EXPECT_FALSE(holds(text, "gnss")) << text;
}

TEST(InputWatch, NamesBothQosOfAnIncompatibleWriter) {
  dds::EndpointStatus camera = reader_of("camera/image", 0, 0);
  camera.incompatible = 1;
  camera.incompatibility = "durability: offered volatile, requested transient local";
  const std::string text = warning({camera, reader_of("gnss/fix", 1, 1)});
  EXPECT_TRUE(holds(text, "offered volatile, requested transient local")) << text;
}

TEST(InputWatch, NamesBothTypesOfAWriterWithAnotherType) {
  dds::EndpointInfo writer;
  writer.type_name = "sensor_msgs::msg::dds_::CompressedImage_";
  dds::TopicInfo topic;
  topic.name = "camera/image";
  topic.writers = {writer};
  dds::DiscoverySnapshot domain;
  domain.topics = {topic};
  const std::vector<dds::EndpointStatus> endpoints = {reader_of("camera/image", 0, 0),
                                                      reader_of("gnss/fix", 1, 1)};
  const std::string text = warning(endpoints, domain);
  EXPECT_TRUE(holds(text, "CompressedImage_ instead of sensor_msgs::msg::dds_::Image_")) << text;
  domain.topics[0].writers[0].own = true;
  EXPECT_TRUE(holds(warning(endpoints, domain), "no writer was found"));
}

TEST(InputWatch, RepeatsAWarningEveryTenLooksAndTellsAChangeAtOnce) {
  InputWatch watch(inputs_of());
  const auto camera = reader_of("camera/image", 1, 1);
  int warnings = 0;
  for (int i = 0; i < 22; ++i) {
    const auto health = watch.look({camera, reader_of("gnss/fix", 0, 0)}, {});
    EXPECT_EQ(health.counters.at("inputs_not_heard"), 1);
    if (health.level != graph::HealthLevel::kOk) ++warnings;
  }
  EXPECT_EQ(warnings, 2);  // at the looks 3 and 13
  const auto changed = watch.look({camera, reader_of("gnss/fix", 0, 1)}, {});
  EXPECT_EQ(changed.level, graph::HealthLevel::kWarn);
}

}  // namespace
}  // namespace furrow::launch
