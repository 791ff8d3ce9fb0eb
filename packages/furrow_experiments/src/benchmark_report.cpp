#include <algorithm>
#include <cmath>

#include "furrow_experiments/planner_benchmark.hpp"
#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/html.hpp"
#include "report_parts.hpp"

namespace furrow::experiments {
namespace {

using ledger::fixed;
using ledger::LineChart;
using ledger::number;

constexpr double kTileDensity = 20.0;  ///< fields with fewer weeds are no strain
constexpr double kGrowthFrom = 200.0;  ///< smaller windows are planned before they are prepared

LineChart time_chart(const PlannerBenchmark& benchmark, const std::vector<BenchmarkRow>& rows,
                     bool by_targets) {
  LineChart chart;
  chart.y_label = by_targets ? "median, \xC2\xB5s" : "p99, \xC2\xB5s";
  chart.log_x = true;
  chart.log_y = true;
  chart.width_px = 600.0;
  chart.height_px = 420.0;
  for (const PlannerChoice& choice : benchmark.planners) {
    const std::string planner = to_string(choice);
    if (planner_color(planner).empty() && choice.planner != "permutation") continue;
    if (choice.planner == "permutation" && choice.assignment != "static") continue;
    LineChart::Series series;
    series.name = planner;
    series.color = choice.planner == "permutation" ? "#5c5c5c" : planner_color(planner);
    for (const BenchmarkRow& row : rows) {
      if (row.planner != planner) continue;
      series.points.push_back({by_targets ? row.targets : row.weeds_per_m2,
                               {by_targets ? row.replan_p50_us : row.replan_p99_us}});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

/// Whether the charts show a row: planners with a colour, and the permutation in its paper's
/// division.
bool is_shown(const std::string& planner) {
  return !planner_color(planner).empty() || planner == "permutation/static";
}

/// Flat where the time is linear in the number of targets.
LineChart cost_chart(const PlannerBenchmark& benchmark, const std::vector<BenchmarkRow>& rows) {
  LineChart chart = time_chart(benchmark, rows, true);
  chart.title = "Time for each target of the window";
  chart.y_label = "median, \xC2\xB5s per target";
  for (LineChart::Series& series : chart.series) {
    for (LineChart::Point& point : series.points) point.y.value /= std::max(1.0, point.x);
  }
  return chart;
}

/// The hardest field of the stream, by the planners that replan jointly.
std::vector<ledger::Tile> tiles(const std::vector<BenchmarkRow>& rows) {
  std::vector<ledger::Tile> tiles;
  for (const BenchmarkRow& row : rows) {
    const bool joint = row.planner == "exact/joint" || row.planner == "footprint/joint";
    if (!joint || row.weeds_per_m2 < kTileDensity) continue;
    std::string note = fixed(1e6 / row.replan_p99_us, 0) + " plans a second";
    if (row.allocations_per_replan) {
      note += "; " + fixed(*row.allocations_per_replan, 2) + " allocations a plan";
    }
    tiles.push_back({row.planner + " at " + number(row.weeds_per_m2, 1) + " weeds/m\xC2\xB2, p99",
                     fixed(1e-3 * row.replan_p99_us, 2) + " ms", note, ""});
  }
  return tiles;
}

std::string growth_text(const std::vector<BenchmarkRow>& rows) {
  std::string text;
  std::vector<std::string> told;
  for (const BenchmarkRow& row : rows) {
    if (!is_shown(row.planner) || std::find(told.begin(), told.end(), row.planner) != told.end()) {
      continue;
    }
    told.push_back(row.planner);
    const double exponent = growth_exponent(rows, row.planner, kGrowthFrom);
    if (!std::isfinite(exponent)) continue;
    text += (text.empty() ? "Power of the number of targets with which the time grows, from " +
                                number(kGrowthFrom) + " targets on (1 is linear): "
                          : ", ") +
            row.planner + " " + fixed(exponent, 2);
  }
  return text.empty() ? text : text + ".";
}

ledger::ReportTable table_of(const std::vector<BenchmarkRow>& rows) {
  ledger::ReportTable table;
  table.header = {"planner", "weeds per m\xC2\xB2", "targets", "p50, \xC2\xB5s", "p99, \xC2\xB5s",
                  "plans",   "allocations"};
  for (const BenchmarkRow& row : rows) {
    table.rows.push_back({row.planner, fixed(row.weeds_per_m2, 1), fixed(row.targets, 0),
                          fixed(row.replan_p50_us, 1), fixed(row.replan_p99_us, 1),
                          std::to_string(row.replans), cell(row.allocations_per_replan, 2)});
  }
  return table;
}

}  // namespace

std::string to_html(const PlannerBenchmark& benchmark, const BenchmarkResult& result,
                    std::string_view version) {
  ledger::HtmlPage page("Time to plan", conditions(benchmark.planner, benchmark.setup,
                                                   benchmark.sampling, benchmark.fields));
  page.tiles(tiles(result.stream));
  LineChart stream = time_chart(benchmark, result.stream, false);
  stream.title = "Replanning at each frame, 99th percentile";
  stream.x_label = "weeds per m\xC2\xB2";
  LineChart window = time_chart(benchmark, result.window, true);
  window.title = "One plan by the number of targets";
  window.x_label = "targets in the window, at 81.2 per m\xC2\xB2";
  page.section(
      "One thread",
      "Left: rolling view, a frame every " + number(benchmark.setup.frame_period_s) + " s, " +
          number(benchmark.setup.look_ahead_m) +
          " m of look-ahead; a replan includes the check of the plan. Right: the whole "
          "window planned from nothing, its memory warm. Allocations: mean of one plan in steady "
          "state.");
  LineChart cost = cost_chart(benchmark, result.window);
  cost.x_label = window.x_label;
  page.figures({to_svg(stream), to_svg(window), to_svg(cost)});
  if (const std::string growth = growth_text(result.window); !growth.empty()) {
    page.paragraph(growth);
  }
  page.section("Stream").table(table_of(result.stream));
  page.section("Window").table(table_of(result.window));
  page.section("Parameters")
      .facts(provenance_facts(benchmark.planner, benchmark.setup, benchmark.sampling, version));
  return page.finish();
}

}  // namespace furrow::experiments
