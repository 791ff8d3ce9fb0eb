#include "furrow_actuation/motion_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "furrow_core/random.hpp"

namespace furrow::actuation {
namespace {

constexpr MotionLimits kAxis{-0.695, 0.695, 5.0, 50.0, 2000.0};

/// Follows the profile's jerks from scratch in small steps, and so shares no formula with at().
struct Integrated {
  MotionState state;
  double max_deviation_m = 0.0;
  double max_deviation_mps = 0.0;
};

Integrated integrate(const MotionProfile& profile, const MotionState& start) {
  Integrated out{start};
  const auto& segments = profile.segments();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const double end_s = i + 1 < segments.size() ? segments[i + 1].start_s : profile.duration_s();
    const double length_s = end_s - segments[i].start_s;
    const int steps = std::max(1, static_cast<int>(length_s / 2e-5));
    const double h = length_s / steps;
    if (segments[i].start.acceleration_mps2 != out.state.acceleration_mps2 &&
        segments[i].jerk_mps3 == 0.0) {
      out.state.acceleration_mps2 = segments[i].start.acceleration_mps2;
    }
    for (int k = 0; k < steps; ++k) {
      const double a_middle = out.state.acceleration_mps2 + segments[i].jerk_mps3 * h / 2.0;
      out.state.position_m += h * out.state.velocity_mps + h * h * a_middle / 2.0;
      out.state.velocity_mps += h * a_middle;
      out.state.acceleration_mps2 += h * segments[i].jerk_mps3;
      const MotionState said = profile.at(segments[i].start_s + h * (k + 1));
      out.max_deviation_m =
          std::max(out.max_deviation_m, std::abs(said.position_m - out.state.position_m));
      out.max_deviation_mps =
          std::max(out.max_deviation_mps, std::abs(said.velocity_mps - out.state.velocity_mps));
    }
  }
  return out;
}

void expect_within(const MotionProfile& profile, const MotionLimits& limits, bool jerk_limited) {
  constexpr double kSlack = 1e-8;
  MotionState last = profile.at(0.0);
  const int samples = 400;
  const double h = profile.duration_s() / samples;
  for (int i = 0; i <= samples; ++i) {
    const MotionState s = profile.at(h * i);
    ASSERT_LE(s.position_m, limits.upper_m + kSlack);
    ASSERT_GE(s.position_m, limits.lower_m - kSlack);
    ASSERT_LE(std::abs(s.velocity_mps), limits.max_velocity_mps + kSlack);
    ASSERT_LE(std::abs(s.acceleration_mps2), limits.max_acceleration_mps2 * (1.0 + kSlack));
    ASSERT_LE(std::abs(s.position_m - last.position_m), limits.max_velocity_mps * h + kSlack);
    ASSERT_LE(std::abs(s.velocity_mps - last.velocity_mps),
              limits.max_acceleration_mps2 * h + kSlack);
    if (jerk_limited) {
      ASSERT_LE(std::abs(s.acceleration_mps2 - last.acceleration_mps2),
                limits.max_jerk_mps3 * h + 1e-6);
    }
    last = s;
  }
}

MotionLimits random_limits(Random& random) {
  return {-0.695, 0.695, random.uniform(0.2, 6.0), random.uniform(2.0, 80.0),
          std::exp(random.uniform(std::log(20.0), std::log(20000.0)))};
}

TEST(Trapezoid, FromRestTakesTheTextbookTime) {
  // 1 m at 5 m/s and 50 m/s2: 0.5 m in the ramps of 0.1 s each, 0.5 m at 5 m/s.
  const auto far = plan_trapezoid(kAxis, {-0.5, 0.0, 0.0}, 0.5);
  ASSERT_TRUE(far.ok());
  EXPECT_NEAR(far->duration_s(), 0.1 + 0.1 + 0.1, 1e-12);
  // 0.1 m never reaches 5 m/s: 2 sqrt(d / a).
  const auto near = plan_trapezoid(kAxis, {0.0, 0.0, 0.0}, 0.1);
  ASSERT_TRUE(near.ok());
  EXPECT_NEAR(near->duration_s(), 2.0 * std::sqrt(0.1 / 50.0), 1e-12);
  EXPECT_NEAR(near->peak_speed_mps(), std::sqrt(0.1 * 50.0), 1e-12);
}

TEST(Trapezoid, RandomStartsArriveWithinTheLimits) {
  Random random(1, "trapezoid");
  int planned = 0;
  for (int i = 0; i < 4000; ++i) {
    const MotionLimits limits = random_limits(random);
    const MotionState start{random.uniform(-0.6, 0.6),
                            limits.max_velocity_mps * random.uniform(-1.0, 1.0), 0.0};
    const double target = random.uniform(limits.lower_m, limits.upper_m);
    const double stop = start.position_m + start.velocity_mps * std::abs(start.velocity_mps) /
                                               (2.0 * limits.max_acceleration_mps2);
    const auto profile = plan_trapezoid(limits, start, target);
    ASSERT_EQ(profile.ok(), stop <= limits.upper_m && stop >= limits.lower_m);
    if (!profile.ok()) continue;
    ++planned;
    expect_within(*profile, limits, false);
    if (i % 10 == 0) {
      const Integrated oracle = integrate(*profile, {start.position_m, start.velocity_mps, 0.0});
      ASSERT_NEAR(oracle.state.position_m, target, 1e-9);
      ASSERT_NEAR(oracle.state.velocity_mps, 0.0, 1e-9);
      ASSERT_LT(oracle.max_deviation_m, 1e-9);
    }
  }
  EXPECT_GT(planned, 2000);
}

/// Time-optimal for the double integrator, by the switching curve simulated in small steps.
double bang_bang_time_s(const MotionLimits& limits, double distance, double v) {
  const double h = 1e-5;
  double x = -distance;
  double t = 0.0;
  while (std::abs(x) > 1e-4 || std::abs(v) > 0.02) {
    const double stop = x + v * std::abs(v) / (2.0 * limits.max_acceleration_mps2);
    double next = v + h * limits.max_acceleration_mps2 * (stop > 0.0 ? -1.0 : 1.0);
    next = std::clamp(next, -limits.max_velocity_mps, limits.max_velocity_mps);
    x += h * (v + next) / 2.0;
    v = next;
    t += h;
    if (t > 20.0) break;
  }
  return t;
}

TEST(Trapezoid, IsAsQuickAsTheSwitchingCurve) {
  Random random(2, "trapezoid");
  for (int i = 0; i < 60; ++i) {
    MotionLimits limits = random_limits(random);
    limits.lower_m = -1e3;
    limits.upper_m = 1e3;
    limits.max_acceleration_mps2 = random.uniform(20.0, 80.0);
    const double v = limits.max_velocity_mps * random.uniform(-1.0, 1.0);
    const double distance = random.uniform(-1.0, 1.0);
    const auto profile = plan_trapezoid(limits, {0.0, v, 0.0}, distance);
    ASSERT_TRUE(profile.ok());
    EXPECT_NEAR(profile->duration_s(), bang_bang_time_s(limits, distance, v), 4e-3);
  }
}

TEST(SCurve, FromRestTakesTheTextbookTime) {
  // Long: d / v + v / a + a / j.
  const auto far = plan_s_curve(kAxis, {-0.6, 0.0, 0.0}, 0.6);
  ASSERT_TRUE(far.ok());
  EXPECT_NEAR(far->duration_s(), 1.2 / 5.0 + 5.0 / 50.0 + 50.0 / 2000.0, 1e-9);
  // Short: only jerk, four equal phases, d = 2 j t^3.
  const auto near = plan_s_curve(kAxis, {0.0, 0.0, 0.0}, 0.01);
  ASSERT_TRUE(near.ok());
  EXPECT_NEAR(near->duration_s(), 4.0 * std::cbrt(0.01 / (2.0 * 2000.0)), 1e-9);
  EXPECT_EQ(plan_s_curve(kAxis, {0.2, 0.0, 0.0}, 0.2)->duration_s(), 0.0);
}

TEST(SCurve, NewTargetsWhileMovingStayWithinTheLimits) {
  Random random(3, "s_curve");
  for (int run = 0; run < 400; ++run) {
    const MotionLimits limits = random_limits(random);
    MotionState state{random.uniform(limits.lower_m, limits.upper_m), 0.0, 0.0};
    for (int change = 0; change < 12; ++change) {
      const bool edge = random.bernoulli(0.2);
      const double target = edge ? limits.upper_m : random.uniform(limits.lower_m, limits.upper_m);
      const auto profile = plan_s_curve(limits, state, target);
      ASSERT_TRUE(profile.ok()) << profile.error().message;
      expect_within(*profile, limits, true);
      EXPECT_EQ(profile->at(profile->duration_s() + 1.0).position_m, target);
      if (change % 4 == 1) {
        const Integrated oracle = integrate(*profile, state);
        ASSERT_NEAR(oracle.state.position_m, target, 1e-7);
        ASSERT_NEAR(oracle.state.velocity_mps, 0.0, 1e-6);
        ASSERT_LT(oracle.max_deviation_m, 1e-7);
        ASSERT_LT(oracle.max_deviation_mps, 1e-6);
      }
      state = profile->at(profile->duration_s() * random.uniform(0.0, 1.1));
    }
  }
}

TEST(SCurve, StopsFromAnyInstantStayWithinTheLimits) {
  Random random(4, "stop");
  for (int run = 0; run < 3000; ++run) {
    const MotionLimits limits = random_limits(random);
    const MotionState rest{random.uniform(limits.lower_m, limits.upper_m), 0.0, 0.0};
    const auto first = plan_s_curve(limits, rest, random.uniform(limits.lower_m, limits.upper_m));
    ASSERT_TRUE(first.ok());
    const MotionState between = first->at(first->duration_s() * random.uniform());
    const auto second = plan_s_curve(limits, between, limits.lower_m);
    ASSERT_TRUE(second.ok());
    const MotionState moving = second->at(second->duration_s() * random.uniform());
    const MotionProfile stop = plan_stop(limits, moving);
    expect_within(stop, limits, true);
    EXPECT_EQ(stop.final_state().velocity_mps, 0.0);
    EXPECT_EQ(stop.final_state().acceleration_mps2, 0.0);
    const Integrated oracle = integrate(stop, moving);
    ASSERT_NEAR(oracle.state.velocity_mps, 0.0, 1e-6);
  }
}

TEST(SCurve, StopsAlsoFromBeyondTheLimits) {
  const MotionProfile stop = plan_stop(kAxis, {0.69, 6.0, 80.0});
  const Integrated oracle = integrate(stop, {0.69, 6.0, 80.0});
  EXPECT_NEAR(oracle.state.velocity_mps, 0.0, 1e-6);
  EXPECT_NEAR(oracle.state.acceleration_mps2, 0.0, 1e-6);
}

/// Random jerk sequences that keep the limits and end at rest must not beat the plan.
TEST(SCurve, NoRandomFeasibleMovementIsQuicker) {
  Random random(5, "s_curve");
  int compared = 0;
  for (int run = 0; run < 20000; ++run) {
    const MotionLimits limits{-10.0, 10.0, random.uniform(0.5, 3.0), random.uniform(5.0, 40.0),
                              random.uniform(100.0, 2000.0)};
    const double a0 = limits.max_acceleration_mps2 * random.uniform(-1.0, 1.0);
    const double room = limits.max_velocity_mps - a0 * a0 / (2.0 * limits.max_jerk_mps3);
    if (room <= 0.0) continue;
    const MotionState start{0.0, room * random.uniform(-1.0, 1.0), a0};
    MotionProfile other(start);
    const double unit = limits.max_acceleration_mps2 / limits.max_jerk_mps3;
    const int phases = static_cast<int>(random.integer(0, 3));
    for (int i = 0; i < phases; ++i) {
      const double share = static_cast<double>(random.integer(-1, 1));
      other.append(unit * random.uniform(0.0, 1.5), share * limits.max_jerk_mps3);
    }
    const MotionProfile stop = plan_stop(limits, other.final_state());
    for (std::size_t i = 0; i < stop.segments().size(); ++i) {
      const double end_s =
          i + 1 < stop.segments().size() ? stop.segments()[i + 1].start_s : stop.duration_s();
      other.append(end_s - stop.segments()[i].start_s, stop.segments()[i].jerk_mps3);
    }
    bool feasible = other.peak_speed_mps() <= limits.max_velocity_mps;
    for (const auto& segment : other.segments()) {
      feasible =
          feasible && std::abs(segment.start.acceleration_mps2) <= limits.max_acceleration_mps2;
    }
    if (!feasible) continue;
    ++compared;
    const auto plan = plan_s_curve(limits, start, other.final_state().position_m);
    ASSERT_TRUE(plan.ok());
    ASSERT_LE(plan->duration_s(), other.duration_s() + 1e-6);
  }
  EXPECT_GT(compared, 2000);
}

TEST(SCurve, BecomesTheTrapezoidAsTheJerkGrows) {
  Random random(6, "s_curve");
  for (int i = 0; i < 500; ++i) {
    MotionLimits limits{-5.0, 5.0, 3.0, 30.0, 1e8};
    const MotionState start{0.0, random.uniform(-3.0, 3.0), 0.0};
    const double target = random.uniform(-2.0, 2.0);
    const auto smooth = plan_s_curve(limits, start, target);
    const auto hard = plan_trapezoid(limits, start, target);
    ASSERT_TRUE(smooth.ok() && hard.ok());
    EXPECT_NEAR(smooth->duration_s(), hard->duration_s(), 1e-4);
    EXPECT_GE(smooth->duration_s(), hard->duration_s() - 1e-9);
  }
}

TEST(Profiles, RefuseBadInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto code = [](const auto& result) { return result.error().code; };
  EXPECT_EQ(code(plan_s_curve(kAxis, {0.0, 0.0, 0.0}, nan)), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code(plan_s_curve(kAxis, {nan, 0.0, 0.0}, 0.0)), ErrorCode::kInvalidArgument);
  EXPECT_EQ(code(plan_s_curve(kAxis, {0.0, 0.0, 0.0}, 0.7)), ErrorCode::kOutOfRange);
  EXPECT_EQ(code(plan_s_curve(kAxis, {0.0, 5.1, 0.0}, 0.0)), ErrorCode::kOutOfRange);
  EXPECT_EQ(code(plan_s_curve(kAxis, {0.0, 0.0, 51.0}, 0.0)), ErrorCode::kOutOfRange);
  EXPECT_EQ(code(plan_s_curve(kAxis, {0.0, 4.9, 50.0}, 0.0)), ErrorCode::kOutOfRange);
  EXPECT_EQ(code(plan_s_curve(kAxis, {0.69, 5.0, 0.0}, 0.0)), ErrorCode::kNoSolution);
  EXPECT_EQ(code(plan_trapezoid(kAxis, {0.69, 5.0, 0.0}, 0.0)), ErrorCode::kNoSolution);
  MotionLimits none = kAxis;
  none.max_jerk_mps3 = 0.0;
  EXPECT_EQ(code(plan_s_curve(none, {0.0, 0.0, 0.0}, 0.1)), ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace furrow::actuation
