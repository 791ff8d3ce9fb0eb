// Sensor topics: our writers are reliable, other drivers offer best effort (ROS 2's REP 2003).

#include <gtest/gtest.h>

#include <algorithm>

#include "test_support.hpp"

namespace furrow::dds {
namespace {

constexpr msgs::Qos kDriverQos = {.reliability = msgs::Reliability::kBestEffort, .depth = 5};

/// Writes `text` until it has arrived: best effort gives no second chance.
bool arrives(graph::TransportWriter& writer, StringInbox& inbox, const std::string& text) {
  return eventually([&] {
    writer.write(make_string(text));
    return std::ranges::count(inbox.items(), text) > 0;
  });
}

TEST(SensorStream, ReadsABestEffortWriterBesideAReliableOne) {
  DdsTransport robot(test_parameters("robot"));
  DdsTransport camera(test_parameters("camera"));
  DdsTransport reader_process(test_parameters("reader"));
  StringInbox inbox;
  const auto reader = reader_process.make_reader("text", string_type(),
                                                 msgs::sensor_stream_qos(100), inbox.handler());
  const auto reliable = robot.make_writer("text", string_type(), msgs::sensor_stream_qos(100));
  auto best_effort = camera.make_writer("text", string_type(), kDriverQos);
  ASSERT_TRUE(eventually([&] { return reader->writers() == 2 && reliable->has_readers(); }));
  EXPECT_TRUE(arrives(*best_effort, inbox, "from the camera"));

  const auto is_reliable = [](const std::string& text) { return text.starts_with("reliable"); };
  std::vector<std::string> expected;
  for (int i = 0; i < 50; ++i) {
    expected.push_back("reliable " + std::to_string(i));
    reliable->write(make_string(expected.back()));
  }
  ASSERT_TRUE(robot.flush(Duration::seconds(5)));
  EXPECT_TRUE(arrives(*best_effort, inbox, "last"));
  std::vector<std::string> received;
  std::ranges::copy_if(inbox.items(), std::back_inserter(received), is_reliable);
  EXPECT_EQ(received, expected) << "each message of the reliable writer must arrive once";

  EndpointStatus status = reader_process.status().front();
  EXPECT_EQ(status.peers, 2);
  EXPECT_EQ(status.best_effort_writers, 1);
  EXPECT_EQ(status.incompatible, 0U);
  best_effort.reset();
  EXPECT_TRUE(eventually([&] { return reader->writers() == 1; }));
  EXPECT_EQ(reader_process.status().front().best_effort_writers, 0);
}

TEST(SensorStream, ReadsABestEffortWriterThatWasThereBefore) {
  DdsTransport camera(test_parameters("camera"));
  DdsTransport reader_process(test_parameters("reader"));
  const auto writer = camera.make_writer("text", string_type(), kDriverQos);
  StringInbox other;
  const auto first = reader_process.make_reader("text", string_type(), kDriverQos, other.handler());
  ASSERT_TRUE(eventually([&] { return first->writers() == 1; }));
  StringInbox inbox;
  const auto late =
      reader_process.make_reader("text", string_type(), msgs::sensor_stream_qos(), inbox.handler());
  EXPECT_TRUE(arrives(*writer, inbox, "hello"));
}

TEST(SensorStream, IsReadByABestEffortReader) {
  DdsTransport robot(test_parameters("robot"));
  DdsTransport viewer(test_parameters("viewer"));
  StringInbox inbox;
  const auto reader = viewer.make_reader("text", string_type(), kDriverQos, inbox.handler());
  const auto writer = robot.make_writer("text", string_type(), msgs::sensor_stream_qos());
  ASSERT_TRUE(eventually([&] { return writer->has_readers(); }));
  EXPECT_TRUE(arrives(*writer, inbox, "hello"));
}

TEST(ReliableStream, ReportsABestEffortWriterAsIncompatible) {
  DdsTransport camera(test_parameters("camera"));
  DdsTransport reader_process(test_parameters("reader"));
  StringInbox inbox;
  const auto reader = reader_process.make_reader("text", string_type(), msgs::reliable_stream_qos(),
                                                 inbox.handler());
  const auto writer = camera.make_writer("text", string_type(), kDriverQos);
  ASSERT_TRUE(eventually([&] { return reader_process.status().front().incompatible == 1; }));
  EXPECT_EQ(reader_process.status().front().incompatibility,
            "reliability: offered best effort, requested reliable (process 'camera')");
  EXPECT_EQ(reader->writers(), 0);
}

}  // namespace
}  // namespace furrow::dds
