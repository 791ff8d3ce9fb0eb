#include "furrow_experiments/planner_benchmark.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "furrow_core/statistics.hpp"
#include "furrow_experiments/drive.hpp"
#include "furrow_experiments/statistics.hpp"
#include "furrow_planning/route_planner.hpp"

namespace furrow::experiments {
namespace {

using Clock = std::chrono::steady_clock;
using Microseconds = std::chrono::duration<double, std::micro>;

constexpr double kWindowDensity = 81.2;  ///< the window grows in length, not in density
constexpr int kMostPlans = 50;

planning::PlannerParameters parameters_of(const PlannerBenchmark& benchmark,
                                          const PlannerChoice& choice) {
  planning::PlannerParameters parameters = benchmark.planner;
  parameters.planner = choice.planner;
  parameters.assignment = choice.assignment;
  parameters.view = "rolling";
  parameters.threads = 1;
  return parameters;
}

std::optional<double> mean_of(const std::vector<std::uint64_t>& counts) {
  if (counts.empty()) return std::nullopt;
  return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::uint64_t{0})) /
         static_cast<double>(counts.size());
}

Result<BenchmarkRow> stream_row(const PlannerBenchmark& benchmark, const PlannerChoice& choice,
                                const FieldCase& field) {
  const auto parameters = parameters_of(benchmark, choice);
  std::vector<double> times_us;
  std::vector<std::uint64_t> allocations;
  const auto begin = Clock::now();
  for (std::int64_t s = 0; s < benchmark.sampling.seeds; ++s) {
    const std::chrono::duration<double> taken = Clock::now() - begin;
    if (s > 0 && taken.count() > benchmark.budget_s) break;
    const auto targets =
        make_targets(field, benchmark.sampling.row,
                     static_cast<std::uint64_t>(benchmark.sampling.first_seed + s));
    if (!targets.ok()) return targets.error();
    const auto driven = drive(*targets, parameters, benchmark.setup, benchmark.allocations);
    if (!driven.ok()) return driven.error();
    const auto& counts = driven->replan_allocations;
    allocations.insert(allocations.end(),
                       counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2),
                       counts.end());
    times_us.insert(times_us.end(), driven->replan_us.begin(), driven->replan_us.end());
  }
  BenchmarkRow row;
  row.planner = to_string(choice);
  row.weeds_per_m2 = field.weeds_per_m2;
  row.targets = field.weeds_per_m2 * benchmark.setup.look_ahead_m * benchmark.sampling.row.width_m;
  row.replans = times_us.size();
  row.replan_p50_us = quantile(times_us, 0.5);
  row.replan_p99_us = quantile(std::move(times_us), 0.99);
  row.allocations_per_replan = mean_of(allocations);
  return row;
}

Result<BenchmarkRow> window_row(const PlannerBenchmark& benchmark, const PlannerChoice& choice,
                                const FieldTargets& field, std::size_t count) {
  auto parameters = parameters_of(benchmark, choice);
  parameters.max_targets = std::max(parameters.max_targets, static_cast<std::int64_t>(count));
  const auto planner = planning::make_route_planner(parameters);
  const auto axes = axis_specs(benchmark.setup);
  const double start_m = start_x_m(benchmark.setup);
  const std::vector<planning::AxisState> states(axes.size(), {.free_from_x_m = start_m});
  const planning::PlanningProblem problem{
      .targets = std::span(field.weeds).first(count),
      .protected_plants = {},
      .axes = axes,
      .states = states,
      .robot = {.x_m = start_m, .speed_mps = parameters.speed_mps}};
  planning::Plan plan;
  std::vector<double> times_us;
  std::vector<std::uint64_t> allocations;
  const auto begin = Clock::now();
  // The first plan fills the planner's memory and is not counted.
  for (int i = 0; i <= kMostPlans; ++i) {
    const std::uint64_t allocated = benchmark.allocations ? benchmark.allocations() : 0;
    const auto before = Clock::now();
    if (Status status = planner->plan(problem, plan); !status.ok()) return status.error();
    const auto after = Clock::now();
    if (i > 0 && benchmark.allocations) {
      allocations.push_back(benchmark.allocations() - allocated);
    }
    if (i > 0) times_us.push_back(Microseconds(after - before).count());
    if (i > 0 && std::chrono::duration<double>(after - begin).count() > benchmark.budget_s) break;
  }
  BenchmarkRow row;
  row.planner = to_string(choice);
  row.weeds_per_m2 = kWindowDensity;
  row.targets = static_cast<double>(count);
  row.replans = times_us.size();
  row.replan_p50_us = quantile(times_us, 0.5);
  row.replan_p99_us = quantile(std::move(times_us), 0.99);
  row.allocations_per_replan = mean_of(allocations);
  return row;
}

/// A field that holds at least `count` weeds.
Result<FieldTargets> window_field(const PlannerBenchmark& benchmark, double count) {
  FieldCase field{"window", kWindowDensity, std::nullopt};
  RowParameters row = benchmark.sampling.row;
  row.length_m = 1.2 * count / (kWindowDensity * row.width_m) + 3.0;
  return make_targets(field, row, static_cast<std::uint64_t>(benchmark.sampling.first_seed));
}

}  // namespace

double growth_exponent(const std::vector<BenchmarkRow>& rows, std::string_view planner,
                       double least_targets) {
  std::vector<std::pair<double, double>> points;
  double mean_x = 0.0;
  double mean_y = 0.0;
  for (const BenchmarkRow& row : rows) {
    if (row.planner != planner || row.targets < least_targets || row.replan_p50_us <= 0.0) continue;
    points.emplace_back(std::log(row.targets), std::log(row.replan_p50_us));
    mean_x += points.back().first;
    mean_y += points.back().second;
  }
  if (points.size() < 2) return std::numeric_limits<double>::quiet_NaN();
  mean_x /= static_cast<double>(points.size());
  mean_y /= static_cast<double>(points.size());
  double xy = 0.0;
  double xx = 0.0;
  for (const auto& [x, y] : points) {
    xy += (x - mean_x) * (y - mean_y);
    xx += (x - mean_x) * (x - mean_x);
  }
  return xy / xx;
}

Result<BenchmarkResult> run(const PlannerBenchmark& benchmark, const Progress& progress) {
  for (const PlannerChoice& choice : benchmark.planners) {
    (void)planning::make_observation_view(parameters_of(benchmark, choice),
                                          axis_specs(benchmark.setup));
  }
  const std::size_t steps =
      benchmark.planners.size() * (benchmark.fields.size() + benchmark.window_targets.size());
  std::size_t done = 0;
  const auto step = [&] {
    ++done;
    if (progress) progress(static_cast<double>(done) / static_cast<double>(steps));
  };
  BenchmarkResult result;
  for (const FieldCase& field : benchmark.fields) {
    for (const PlannerChoice& choice : benchmark.planners) {
      auto row = stream_row(benchmark, choice, field);
      if (!row.ok()) return row.error();
      result.stream.push_back(std::move(*row));
      step();
    }
  }
  if (benchmark.window_targets.empty()) return result;
  const std::int64_t largest =
      *std::max_element(benchmark.window_targets.begin(), benchmark.window_targets.end());
  const auto field = window_field(benchmark, static_cast<double>(largest));
  if (!field.ok()) return field.error();
  for (const std::int64_t targets : benchmark.window_targets) {
    const auto count = static_cast<std::size_t>(targets);
    if (targets < 1 || count > field->weeds.size()) {
      return Error{ErrorCode::kOutOfRange,
                   "a window of " + std::to_string(targets) + " targets cannot be made"};
    }
    for (const PlannerChoice& choice : benchmark.planners) {
      auto row = window_row(benchmark, choice, *field, count);
      if (!row.ok()) return row.error();
      result.window.push_back(std::move(*row));
      step();
    }
  }
  return result;
}

}  // namespace furrow::experiments
