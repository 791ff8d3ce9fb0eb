// Time of one step of the tracker with about 200 plants in view.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "../test/simulated_row.hpp"

namespace {

using namespace furrow::tracking;

void tracker_step(benchmark::State& state, const std::string& association, bool row_prior) {
  // Without weeds standing too close, about 200 of them in the 1.1 m that the camera sees.
  const test::Row row(1, {.length_m = 20.0, .weeds_per_m2 = 140.0, .least_distance_m = 0.01});
  TrackerParameters parameters;
  parameters.association = association;
  parameters.rows.row_prior = row_prior;
  std::vector<View> views;
  std::vector<std::vector<Observation>> observations;
  for (int i = 0; i < row.views(); ++i) {
    views.push_back(row.view(i));
    observations.push_back(row.observe(views.back()));
  }
  Tracker tracker(parameters);
  std::size_t next = 0;
  std::size_t seen = 0;
  for (auto _ : state) {
    if (next == views.size()) {
      state.PauseTiming();
      tracker = Tracker(parameters);
      next = 0;
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(tracker.update(views[next], observations[next]));
    seen += observations[next].size();
    ++next;
  }
  state.counters["plants_in_view"] =
      static_cast<double>(seen) / static_cast<double>(state.iterations());
}

BENCHMARK_CAPTURE(tracker_step, dynamic_radius, "dynamic_radius", false)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tracker_step, dynamic_radius_and_rows, "dynamic_radius", true)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tracker_step, fixed_radius, "fixed_radius", false)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(tracker_step, iou, "iou", false)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
