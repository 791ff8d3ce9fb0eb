#include <cstdlib>
#include <numeric>
#include <optional>

#include "furrow_msgs/nav_msgs.h"
#include "furrow_msgs/topics.hpp"
#include "peer_process.hpp"
#include "test_support.hpp"

namespace furrow::dds {
namespace {

using nav_msgs::msg::Odometry;
namespace topics = msgs::topics;

/// Beside a process with another vendor's DDS.
class CycloneTest : public ::testing::Test {
 protected:
  void SetUp() override {
    reader_ = transport_.make_reader("cyclone/answer", msgs::message_type<Odometry>(),
                                     msgs::event_qos(), [this](const graph::MessagePtr& message) {
                                       answers_.put(*static_cast<const Odometry*>(message.get()));
                                     });
    setenv("CYCLONEDDS_URI",
           "<General><Interfaces><NetworkInterface address='127.0.0.1'/></Interfaces>"
           "<AllowMulticast>false</AllowMulticast></General>"
           "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
           "<Peers><Peer address='127.0.0.1'/></Peers></Discovery>",
           1);
    peer_.emplace(FURROW_CYCLONE_PEER);
  }
  std::unique_ptr<graph::TransportWriter> writer(const msgs::Topic& topic) {
    auto writer = transport_.make_writer(std::string(topic.name), *topic.type, topic.qos);
    EXPECT_TRUE(eventually([&] { return writer->has_readers() && reader_->writers() == 1; }));
    return writer;
  }

  /// Repeats the message until it is answered: one side may match earlier than the other.
  std::optional<Odometry> answer_to(graph::TransportWriter& out, const graph::MessagePtr& message,
                                    const std::string& frame) {
    std::optional<Odometry> found;
    constexpr std::chrono::milliseconds kAgain{100};
    auto sent = std::chrono::steady_clock::time_point();
    const bool answered = eventually([&] {
      if (std::chrono::steady_clock::now() - sent > kAgain) {
        sent = std::chrono::steady_clock::now();
        out.write(message);
      }
      for (const Odometry& answer : answers_.items()) {
        if (answer.header().frame_id() == frame) found = answer;
      }
      return found.has_value();
    });
    EXPECT_TRUE(answered);
    return found;
  }

  DdsTransport transport_{test_parameters("furrow")};
  Inbox<Odometry> answers_;
  std::unique_ptr<graph::TransportReader> reader_;
  std::optional<PeerProcess> peer_;
};

TEST_F(CycloneTest, CycloneReadsOurImages) {
  const auto out = writer(topics::CameraImage::topic());
  // One that fits into a packet, and one of 1280 x 960 pixels in three colours.
  for (const std::size_t bytes : {300U, 3'686'400U}) {
    auto image = std::make_shared<Image>(*make_image(bytes, 5));
    const std::string frame = "camera " + std::to_string(bytes);
    image->header().frame_id(frame);
    image->height(960);
    const auto answer = answer_to(*out, image, frame);
    ASSERT_TRUE(answer);
    const auto& position = answer->pose().pose().position();
    EXPECT_EQ(position.x(), 960.0);
    EXPECT_EQ(position.y(), static_cast<double>(bytes));
    EXPECT_EQ(position.z(), std::accumulate(image->data().begin(), image->data().end(), 0.0));
  }
}

TEST_F(CycloneTest, ReadsACameraThatOffersBestEffort) {
  Inbox<graph::MessagePtr> images;
  const msgs::Topic& topic = topics::CameraImage::topic();
  const auto camera =
      transport_.make_reader("cyclone/image", *topic.type, topic.qos,
                             [&images](graph::MessagePtr message) { images.put(message); });
  const auto out = writer(topics::RobotOdometry::topic());
  ASSERT_TRUE(eventually([&] { return camera->writers() == 1; }));
  auto odometry = std::make_shared<Odometry>();
  odometry->header().frame_id("field");
  ASSERT_TRUE(eventually([&] {
    out->write(odometry);
    return !images.items().empty();
  }));
  const auto& image = *static_cast<const Image*>(images.items().front().get());
  EXPECT_EQ(image.header().frame_id(), "field");
  EXPECT_EQ(image.data(), std::vector<std::uint8_t>{7});
}

TEST_F(CycloneTest, ExchangesOdometryWithCyclone) {
  const auto out = writer(topics::RobotOdometry::topic());
  auto odometry = std::make_shared<Odometry>();
  odometry->header().frame_id("field");
  odometry->pose().pose().position().x(1.25);
  odometry->pose().pose().position().y(-0.5);
  odometry->pose().pose().position().z(1e-9);
  odometry->twist().twist().linear().x(0.5);
  const auto answer = answer_to(*out, odometry, "field");
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->child_frame_id(), "cyclone");
  EXPECT_EQ(answer->pose().pose().position().x(), 2.5);
  EXPECT_EQ(answer->pose().pose().position().y(), -1.0);
  EXPECT_EQ(answer->pose().pose().position().z(), 2e-9);
  EXPECT_EQ(answer->pose().pose().orientation().w(), 1.0);
  EXPECT_EQ(answer->twist().twist().linear().x(), 1.0);
  EXPECT_EQ(answer->twist().covariance()[35], 0.25);
}

}  // namespace
}  // namespace furrow::dds
