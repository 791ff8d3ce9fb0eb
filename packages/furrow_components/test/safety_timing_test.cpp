// The time until an axis driver shuts its valve: in real time, with the driver on a dedicated
// thread as in the graphs. Each repetition opens the valve, then triggers the cause.

#include "furrow_core/test_support/undisturbed_rounds.hpp"
#include "safety_repetitions.hpp"

namespace furrow::components::safety_timing {
namespace {

/// The longest time until the valve was shut, in ms.
double longest(const Outcome& outcome, const std::string& cause) {
  std::vector<double> sorted = outcome.shut_after_ms;
  std::ranges::sort(sorted);
  std::printf("%s: valve shut after p50 %.2f ms, p100 %.2f ms\n", cause.c_str(),
              sorted[sorted.size() / 2], sorted.back());
  testing::Test::RecordProperty(cause + "_p100_us", static_cast<int>(1e3 * sorted.back()));
  EXPECT_GE(sorted.front(), 0.0);
  return sorted.back();
}

void expect_shut_within(double limit_ms, Cause cause) {
  const std::string name = latched_by(cause);
  expect_within_in_an_undisturbed_round(limit_ms, name, [&] {
    Outcome outcome;
    if (!repeat(cause, outcome)) return std::numeric_limits<double>::infinity();
    return longest(outcome, name);
  });
}

TEST(SafetyTiming, EmergencyStop) {
  expect_shut_within(20.0, Cause::kEmergencyStop);
}

TEST(SafetyTiming, OdometryThatIsNotFinite) {
  expect_shut_within(20.0, Cause::kOdometryInvalid);
}

TEST(SafetyTiming, SilentPlanner) {
  expect_shut_within(100.0, Cause::kPlannerSilent);
}

}  // namespace
}  // namespace furrow::components::safety_timing
