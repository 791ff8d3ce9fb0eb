// What a cycle of the control loop costs, and planning a movement.

#include <benchmark/benchmark.h>

#include "../test/rig.hpp"
#include "furrow_core/random.hpp"

namespace furrow::actuation {
namespace {

constexpr Duration kPeriod = Duration::milliseconds(2);

/// One axis over a row of targets without end, with a plan of `stops` stops and `crops` protected
/// plants; one iteration is one cycle of 2 ms: reading, deciding, writing.
void control_cycle(benchmark::State& state) {
  const geometry::AxisModel axis = testing::paper_axis(0);
  AxisController controller(axis, {}, {});
  SimulatedAxisDriver driver(MotionLimits::of(axis), {.start_ready = true});
  const auto stops = static_cast<std::size_t>(state.range(0));
  const auto crops = static_cast<std::size_t>(state.range(1));
  constexpr double kSpeed_mps = 0.5;
  constexpr double kSpacing_m = 0.15;
  std::vector<PlannedStop> plan(stops);
  std::vector<ProtectedPlant> protected_plants(crops);
  std::int64_t cycle = 0;
  std::int64_t sprays = 0;
  for (auto _ : state) {
    const Time now = Time::from_nanoseconds(cycle * kPeriod.count_ns());
    const double x_m = kSpeed_mps * now.to_seconds();
    if (cycle % 5 == 0)
      controller.set_odometry(now, {now, {x_m, 0.0, 0.0}, {kSpeed_mps, 0.0, 0.0}});
    if (cycle % 100 == 0) {
      const auto first = static_cast<std::int64_t>((x_m + 0.18) / kSpacing_m);
      for (std::size_t i = 0; i < stops; ++i) {
        const std::int64_t id = first + static_cast<std::int64_t>(i) + 1;
        const double y_m = 0.6 * static_cast<double>(id * 7919 % 1000) / 1000.0 - 0.3;
        plan[i] = testing::stop_at(id, {kSpacing_m * static_cast<double>(id), y_m}, now);
      }
      for (std::size_t i = 0; i < crops; ++i) {
        protected_plants[i] = {static_cast<std::int64_t>(i),
                               {x_m + 0.02 * static_cast<double>(i), 0.5}};
      }
      if (!controller.set_plan(now, plan).ok()) state.SkipWithError("the plan was not taken");
      controller.set_protected(now, protected_plants);
    }
    (void)driver.read(now, kPeriod).ok();
    controller.set_reading(now, driver.reading());
    controller.safety().heartbeat_came(now);
    const ControllerOutput output = controller.update(now, kPeriod);
    controller.safety().valve_written(now, output.valve_open, true);
    (void)driver.write(now, kPeriod, output.axis).ok();
    for (const ControllerEvent& event : output.events) {
      sprays += event.kind == ControllerEventKind::kSprayClosed ? 1 : 0;
    }
    ++cycle;
  }
  state.counters["sprays_per_s"] =
      static_cast<double>(sprays) / (static_cast<double>(cycle) * kPeriod.to_seconds());
}
BENCHMARK(control_cycle)->Args({4, 8})->Args({64, 8})->Args({64, 512});

void plan_movement(benchmark::State& state) {
  const MotionLimits limits = MotionLimits::of(testing::paper_axis(0));
  Random random(1, "movements");
  for (auto _ : state) {
    const auto profile =
        plan_s_curve(limits, {random.uniform(-0.3, 0.3), random.uniform(-1.0, 1.0), 0.0},
                     random.uniform(-0.6, 0.6));
    benchmark::DoNotOptimize(profile.ok());
  }
}
BENCHMARK(plan_movement);

}  // namespace
}  // namespace furrow::actuation

BENCHMARK_MAIN();
