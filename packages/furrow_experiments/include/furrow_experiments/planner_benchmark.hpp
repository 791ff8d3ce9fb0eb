#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_experiments/evaluation.hpp"
#include "furrow_experiments/planner_choice.hpp"

namespace furrow::experiments {

/// How long planning takes, on one thread.
struct PlannerBenchmark {
  std::vector<FieldCase> fields = paper_field_cases();
  std::vector<PlannerChoice> planners = all_planner_choices();
  planning::PlannerParameters planner;
  SetupParameters setup;
  SamplingParameters sampling;
  double budget_s = 5.0;  ///< no further field is driven for a row that has taken this long
  std::vector<std::int64_t> window_targets = {50, 100, 200, 500, 1000, 2000, 5000};
  AllocationCount allocations;  ///< empty: not counted
};

struct BenchmarkRow {
  std::string planner;  ///< "exact/joint"
  double weeds_per_m2 = 0.0;
  double targets = 0.0;  ///< in the window, on average
  double replan_p50_us = 0.0;
  double replan_p99_us = 0.0;
  std::size_t replans = 0;
  /// Mean in steady state: the second half of each drive; a window that was planned before.
  std::optional<double> allocations_per_replan;
};

struct BenchmarkResult {
  std::vector<BenchmarkRow> stream;  ///< replanning at each frame of the rolling view
  std::vector<BenchmarkRow> window;  ///< one plan of a window of that many targets, at 81.2 per m2
};

/// The power of the number of targets with which the median time grows, fitted to the rows of a
/// planner with at least `least_targets`; 1 is linear. Not a number for fewer than two such rows.
[[nodiscard]] double growth_exponent(const std::vector<BenchmarkRow>& rows,
                                     std::string_view planner, double least_targets);

/// Errors and exceptions: as drive_all.
[[nodiscard]] Result<BenchmarkResult> run(const PlannerBenchmark& benchmark,
                                          const Progress& progress = {});

/// For a terminal.
[[nodiscard]] std::string to_text(const BenchmarkResult& result);
/// One object: rows with the keys of `furrow bench planner`, window rows, parameters, version.
[[nodiscard]] std::string to_json(const PlannerBenchmark& benchmark, const BenchmarkResult& result,
                                  std::string_view version);
/// A self-contained page.
[[nodiscard]] std::string to_html(const PlannerBenchmark& benchmark, const BenchmarkResult& result,
                                  std::string_view version);

}  // namespace furrow::experiments
