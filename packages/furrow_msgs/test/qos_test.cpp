#include "furrow_msgs/qos.hpp"

#include <gtest/gtest.h>

namespace furrow::msgs {
namespace {

TEST(Qos, AReaderMayRequestLessThanTheWriterOffers) {
  EXPECT_EQ(incompatibility(latched_qos(), latched_qos()), "");
  EXPECT_EQ(incompatibility(latched_qos(), {.reliability = Reliability::kBestEffort}), "");
  EXPECT_EQ(incompatibility({.deadline = Duration::milliseconds(10)},
                            {.deadline = Duration::milliseconds(20)}),
            "");
}

TEST(Qos, AnIncompatibilityNamesThePolicyAndBothValues) {
  EXPECT_EQ(incompatibility({.reliability = Reliability::kBestEffort}, reliable_stream_qos()),
            "reliability: offered best effort, requested reliable");
  EXPECT_EQ(incompatibility({.reliability = Reliability::kBestEffort}, latched_qos()),
            "reliability: offered best effort, requested reliable; "
            "durability: offered volatile, requested transient local");
  EXPECT_EQ(incompatibility({}, {.deadline = Duration::milliseconds(20),
                                 .liveliness_lease = Duration::milliseconds(100)}),
            "deadline: offered none, requested 20 ms; "
            "liveliness lease: offered none, requested 100 ms");
}

TEST(Qos, ReadersOfSensorStreamsAcceptBestEffort) {
  EXPECT_EQ(incompatibility({.reliability = Reliability::kBestEffort}, sensor_stream_qos()), "");
  EXPECT_EQ(sensor_stream_qos().reliability, Reliability::kReliable);
}

}  // namespace
}  // namespace furrow::msgs
