#include "furrow_evaluation/trial_pace.hpp"

#include <gtest/gtest.h>

#include "furrow_components/conversions.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::evaluation {
namespace {

namespace topics = msgs::topics;

constexpr double kLength_m = 4.0;

/// A base that starts 1 m before the field at 0.5 m/s, and from its second metre on has 0.25 m/s.
graph::ComponentClass robot(double seconds) {
  graph::ComponentClass type{.name = "robot"};
  type.description.output<topics::TrueOdometry>();
  type.make = [seconds](graph::Context& context) {
    auto out = context.output<topics::TrueOdometry>();
    context.every(Duration::milliseconds(10), [seconds, out, &context](Time now) {
      const double t_s = now.to_seconds();
      const bool slow = t_s > 6.0;
      const double x_m = slow ? 2.0 + 0.25 * (t_s - 6.0) : -1.0 + 0.5 * t_s;
      out.publish(components::to_msg({now, {x_m, 0.0, 0.0}, slow ? 0.25 : 0.5, 0.0}, "field"));
      if (t_s >= seconds) context.request_stop("finished");
    });
    return std::make_unique<graph::Component>();
  };
  return type;
}

Pace pace_of(double seconds) {
  graph::Registry registry;
  registry.add(robot(seconds));
  graph::GraphSpec spec;
  spec.components = {{.name = "robot", .group = "robot", .class_name = "robot"}};
  PaceObserver observer(kLength_m);
  observer.add_to(spec, registry);
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kLockstep, .threads = 1});
  EXPECT_EQ(runtime.run().reason, "finished");
  return observer.pace();
}

TEST(PaceObserver, TimesTheFieldWithoutTheWayInAndOut) {
  const Pace pace = pace_of(20.0);
  // 2 m in 4 s and 2 m in 8 s, to a step of the odometry at either end.
  EXPECT_NEAR(pace.way_m, kLength_m, 0.011);
  EXPECT_NEAR(pace.time_s, 12.0, 0.031);
  EXPECT_EQ(pace.least_mps, 0.25);
  EXPECT_EQ(pace.greatest_mps, 0.5);
}

TEST(PaceObserver, HasNoWayWhereTheFieldWasNotReached) {
  const Pace pace = pace_of(1.0);
  EXPECT_EQ(pace.way_m, 0.0);
  EXPECT_EQ(pace.time_s, 0.0);
}

}  // namespace
}  // namespace furrow::evaluation
