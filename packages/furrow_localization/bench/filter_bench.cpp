// Time of one measurement in the filter, and of a pose read from it.
#include <benchmark/benchmark.h>

#include "../test/simulated_drive.hpp"

namespace {

using namespace furrow::localization;

void filter_step(benchmark::State& state) {
  const test::DriveOptions options;
  const test::Drive drive = test::simulate_drive(1, options);
  PoseFilter filter(test::parameters_for(options));
  std::size_t next = 0;
  for (auto _ : state) {
    if (next == drive.measurements.size()) {
      state.PauseTiming();
      filter = PoseFilter(test::parameters_for(options));
      next = 0;
      state.ResumeTiming();
    }
    benchmark::DoNotOptimize(test::add(filter, drive.measurements[next]));
    ++next;
  }
}

void filter_predict(benchmark::State& state) {
  const test::DriveOptions options;
  const test::Drive drive = test::simulate_drive(1, options);
  PoseFilter filter(test::parameters_for(options));
  for (const auto& measurement : drive.measurements) test::add(filter, measurement);
  const furrow::Time ahead =
      test::stamp_of(drive.measurements.back()) + furrow::Duration::milliseconds(5);
  for (auto _ : state) benchmark::DoNotOptimize(filter.predict(ahead));
}

// A GNSS measurement that arrives 100 ms late: the later measurements are applied again.
void filter_late_gnss(benchmark::State& state) {
  const test::DriveOptions options;
  const test::Drive drive = test::simulate_drive(1, options);
  PoseFilter filter(test::parameters_for(options));
  std::size_t next = 0;
  std::vector<GnssPosition> held;
  for (auto _ : state) {
    state.PauseTiming();
    GnssPosition due;
    bool found = false;
    while (!found) {
      if (next == drive.measurements.size()) {
        filter = PoseFilter(test::parameters_for(options));
        next = 0;
        held.clear();
      }
      const auto& measurement = drive.measurements[next++];
      if (const auto* fix = std::get_if<GnssPosition>(&measurement)) {
        held.push_back(*fix);
      } else {
        test::add(filter, measurement);
      }
      if (held.empty()) continue;
      const auto age = test::stamp_of(measurement) - held.front().stamp;
      if (age < furrow::Duration::milliseconds(100)) continue;
      due = held.front();
      held.erase(held.begin());
      found = true;
    }
    state.ResumeTiming();
    benchmark::DoNotOptimize(filter.add(due));
  }
}

BENCHMARK(filter_step)->Unit(benchmark::kMicrosecond);
BENCHMARK(filter_predict)->Unit(benchmark::kMicrosecond);
BENCHMARK(filter_late_gnss)->Unit(benchmark::kMicrosecond);

}  // namespace

BENCHMARK_MAIN();
