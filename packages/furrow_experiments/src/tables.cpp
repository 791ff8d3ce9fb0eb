#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/text.hpp"
#include "furrow_experiments/biodiversity_experiment.hpp"
#include "furrow_experiments/observation_experiment.hpp"
#include "furrow_experiments/planner_benchmark.hpp"

namespace furrow::experiments {
namespace {

using Lines = std::vector<std::vector<std::string>>;

std::string or_dash(const std::optional<double>& value, int decimals) {
  return value ? fixed(*value, decimals) : "-";
}

std::string with_spread(double mean, double spread, int decimals) {
  return std::isnan(spread) ? fixed(mean, decimals)
                            : fixed(mean, decimals) + "±" + fixed(spread, decimals);
}

std::string planner_of(const EvaluationRow& row) {
  return row.planner + "/" + row.assignment;
}

Lines lines_of(const std::vector<BenchmarkRow>& rows) {
  Lines lines = {{"planner", "per m2", "targets", "p50 us", "p99 us", "plans", "allocations"}};
  for (const BenchmarkRow& row : rows) {
    lines.push_back({row.planner, fixed(row.weeds_per_m2, 1), fixed(row.targets, 0),
                     fixed(row.replan_p50_us, 1), fixed(row.replan_p99_us, 1),
                     std::to_string(row.replans), or_dash(row.allocations_per_replan, 2)});
  }
  return lines;
}

}  // namespace

std::string to_table(const ObservationResult& result) {
  Lines lines = {{"field", "per m2", "planner", "view", "loss %", "travel m", "paper %",
                  "optimum %", "p50 us", "p99 us"}};
  for (const EvaluationRow& row : result.rows) {
    lines.push_back({row.field, fixed(row.weeds_per_m2, 1), planner_of(row), row.view,
                     with_spread(row.loss_pct, row.loss_ci95, 2),
                     with_spread(row.travel_m_mean, row.travel_m_sd, 1),
                     or_dash(row.paper_loss_pct, 1), fixed(row.optimum_loss_pct, 2),
                     fixed(row.replan_p50_us, 0), fixed(row.replan_p99_us, 0)});
  }
  return text_table(lines);
}

std::string to_table(const BiodiversityResult& result) {
  Lines lines = {{"field", "per m2", "planner", "view", "scheme", "low %", "high %", "loss %",
                  "paper low", "paper high"}};
  for (const EvaluationRow& row : result.rows) {
    const auto& priorities = *row.priorities;
    lines.push_back({row.field, fixed(row.weeds_per_m2, 1), planner_of(row), row.view,
                     priorities.scheme, fixed(priorities.treated_low_pct, 1),
                     fixed(priorities.treated_high_pct, 1),
                     with_spread(row.loss_pct, row.loss_ci95, 2),
                     or_dash(priorities.paper_low_pct, 1), or_dash(priorities.paper_high_pct, 1)});
  }
  return text_table(lines);
}

std::string to_text(const BenchmarkResult& result) {
  return "replanning at each frame\n" + text_table(lines_of(result.stream)) +
         "\none plan of a window with so many targets\n" + text_table(lines_of(result.window));
}

}  // namespace furrow::experiments
