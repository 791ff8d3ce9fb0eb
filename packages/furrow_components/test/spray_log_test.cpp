#include "../src/spray_log.hpp"

#include <gtest/gtest.h>

#include "furrow_graph/stamp.hpp"

namespace furrow::components {
namespace {

using furrow_msgs::msg::AxisEvent;

constexpr Duration kDelay = Duration::milliseconds(7);

Time at_ms(std::int64_t ms) {
  return Time::from_nanoseconds(ms * 1'000'000);
}

/// An axis that starts at 0.2 m with 0.1 m/s.
actuation::AxisReading reading_at(Time now) {
  actuation::AxisReading reading;
  reading.position_m = 0.2 + 0.1 * now.to_seconds();
  reading.velocity_mps = 0.1;
  return reading;
}

TEST(SprayLog, MeasuresTheAxisAtFirstAndLastDrop) {
  SprayLog log(kDelay);
  std::vector<AxisEvent> events;
  for (std::int64_t ms = 0; ms <= 40; ms += 2) {
    if (ms == 10) log.open(AxisEvent(), at_ms(10));
    EXPECT_EQ(log.opened() != nullptr, ms >= 10 && ms <= 20) << ms;
    if (ms == 20) log.close(at_ms(20));
    if (auto event = log.sample(at_ms(ms), reading_at(at_ms(ms)))) {
      EXPECT_EQ(ms, 28);  // the first cycle after 27
      events.push_back(*event);
    }
  }
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(graph::from_msg(events[0].opened()), at_ms(10));
  EXPECT_EQ(graph::from_msg(events[0].closed()), at_ms(20));
  EXPECT_EQ(graph::from_msg(events[0].header().stamp()), at_ms(27));
  EXPECT_NEAR(events[0].position_opened_m(), 0.2 + 0.1 * 0.017, 1e-12);
  EXPECT_NEAR(events[0].position_closed_m(), 0.2 + 0.1 * 0.027, 1e-12);
  EXPECT_EQ(events[0].velocity_closed_mps(), 0.1);
}

TEST(SprayLog, OverlappingSpraysKeepTheirOrder) {
  SprayLog log(kDelay);
  std::vector<std::int64_t> stops;
  for (std::int64_t ms = 0; ms <= 60; ms += 2) {
    // The second opens before the last drop of the first has left.
    for (const std::int64_t stop : {1, 2}) {
      if (ms == 10 * stop) {
        AxisEvent event;
        event.stop_id(stop);
        log.open(event, at_ms(ms));
      }
      if (ms == 10 * stop + 6) log.close(at_ms(ms));
    }
    if (auto event = log.sample(at_ms(ms), reading_at(at_ms(ms)))) {
      stops.push_back(event->stop_id());
      EXPECT_NEAR(event->position_opened_m(),
                  0.2 + 0.1 * (1e-3 * 10.0 * static_cast<double>(event->stop_id()) + 0.007), 1e-12);
    }
  }
  EXPECT_EQ(stops, (std::vector<std::int64_t>{1, 2}));
}

TEST(SprayLog, CloseWithoutOpenIsIgnored) {
  SprayLog log(kDelay);
  log.close(at_ms(1));
  EXPECT_EQ(log.opened(), nullptr);
  EXPECT_FALSE(log.sample(at_ms(100), {}).has_value());
}

}  // namespace
}  // namespace furrow::components
