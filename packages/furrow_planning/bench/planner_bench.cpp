// Time of one plan from nothing, with the allocations that it makes once memory is warm.
#include <benchmark/benchmark.h>

#include <atomic>
#include <cstdlib>
#include <new>
#include <string>

#include "furrow_planning/plan_checker.hpp"
#include "furrow_planning/route_planner.hpp"
#include "stream.hpp"

namespace {

std::atomic<std::int64_t> allocations{0};

}  // namespace

// Not inlined, so that compilers see the operators match where they are used.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) {
    return memory;
  }
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace furrow::planning::bench {
namespace {

struct Window {
  std::vector<Target> targets;
  std::vector<AxisSpec> axes = four_axes();
  std::vector<AxisState> states;

  Window(double per_m2, double length_m) : targets(poisson_field(per_m2, length_m, 1.39, 7)) {
    for (std::size_t a = 0; a < axes.size(); ++a) {
      states.push_back({.position_m = 1.39 * (static_cast<double>(a) + 0.5) / 4.0 - 0.695,
                        .free_from_x_m = -0.2});
    }
  }
  [[nodiscard]] PlanningProblem problem() const {
    return {.targets = targets,
            .protected_plants = {},
            .axes = axes,
            .states = states,
            .robot = {.x_m = -0.2}};
  }
};

PlannerParameters parameters_for(const std::string& planner, const std::string& assignment) {
  PlannerParameters parameters;
  parameters.planner = planner;
  parameters.assignment = assignment;
  return parameters;
}

void measure(benchmark::State& state, const std::string& planner, const std::string& assignment,
             double per_m2, double length_m) {
  const Window window(per_m2, length_m);
  const auto parameters = parameters_for(planner, assignment);
  const auto route_planner = make_route_planner(parameters);
  Plan plan;
  bool sound = true;
  for (int i = 0; i < 3; ++i) {
    sound = sound && route_planner->plan(window.problem(), plan).ok();
  }
  const std::int64_t before = allocations;
  for (auto _ : state) {
    sound = sound && route_planner->plan(window.problem(), plan).ok();
    benchmark::ClobberMemory();
  }
  state.counters["allocations"] =
      static_cast<double>(allocations - before) / static_cast<double>(state.iterations());
  state.counters["targets"] = static_cast<double>(window.targets.size());
  state.counters["treated_pct"] = 100.0 * plan.weight / static_cast<double>(window.targets.size());
  if (!sound || !PlanChecker(parameters).check(window.problem(), plan)) {
    state.SkipWithError("the plan is not sound");
  }
}

void check(benchmark::State& state, double per_m2) {
  const Window window(per_m2, 1.36);
  const auto parameters = parameters_for("footprint", "joint");
  Plan plan;
  PlanChecker checker(parameters);
  bool sound = make_route_planner(parameters)->plan(window.problem(), plan).ok();
  for (auto _ : state) {
    sound = sound && checker.check(window.problem(), plan).ok();
  }
  if (!sound) {
    state.SkipWithError("the plan is not sound");
  }
}

void register_all() {
  const std::pair<const char*, const char*> planners[] = {
      {"greedy", "static"}, {"greedy", "joint"}, {"notsp", "static"},   {"permutation", "static"},
      {"exact", "static"},  {"exact", "joint"},  {"footprint", "joint"}};
  for (const auto& [planner, assignment] : planners) {
    const std::string name = std::string(planner) + "_" + assignment;
    for (const double per_m2 : {15.4, 22.3, 81.2}) {
      benchmark::RegisterBenchmark(
          (name + "/per_m2:" + std::to_string(per_m2).substr(0, 4)).c_str(),
          [=](benchmark::State& state) { measure(state, planner, assignment, per_m2, 1.36); })
          ->Unit(benchmark::kMicrosecond);
    }
    for (const int targets : {50, 150, 500, 1500, 5000}) {
      benchmark::RegisterBenchmark((name + "/targets:" + std::to_string(targets)).c_str(),
                                   [=](benchmark::State& state) {
                                     measure(state, planner, assignment, 22.3,
                                             targets / (22.3 * 1.39));
                                   })
          ->Unit(benchmark::kMicrosecond);
    }
  }
  for (const double per_m2 : {22.3, 81.2}) {
    benchmark::RegisterBenchmark(("checker/per_m2:" + std::to_string(per_m2).substr(0, 4)).c_str(),
                                 [=](benchmark::State& state) { check(state, per_m2); })
        ->Unit(benchmark::kMicrosecond);
  }
}

}  // namespace
}  // namespace furrow::planning::bench

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  furrow::planning::bench::register_all();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
