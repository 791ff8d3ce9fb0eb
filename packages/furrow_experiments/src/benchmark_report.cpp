#include "furrow_experiments/planner_benchmark.hpp"
#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/html.hpp"
#include "report_parts.hpp"

namespace furrow::experiments {
namespace {

using ledger::fixed;
using ledger::LineChart;
using ledger::number;

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

ledger::ReportTable table_of(const std::vector<BenchmarkRow>& rows) {
  ledger::ReportTable table;
  table.header = {"planner",        "weeds per m\xC2\xB2", "targets",
                  "p50, \xC2\xB5s", "p99, \xC2\xB5s",      "plans"};
  for (const BenchmarkRow& row : rows) {
    table.rows.push_back({row.planner, fixed(row.weeds_per_m2, 1), fixed(row.targets, 0),
                          fixed(row.replan_p50_us, 1), fixed(row.replan_p99_us, 1),
                          std::to_string(row.replans)});
  }
  return table;
}

}  // namespace

std::string to_html(const PlannerBenchmark& benchmark, const BenchmarkResult& result,
                    std::string_view version) {
  ledger::HtmlPage page("Time to plan", conditions(benchmark.planner, benchmark.setup,
                                                   benchmark.sampling, benchmark.fields));
  LineChart stream = time_chart(benchmark, result.stream, false);
  stream.title = "Replanning at each frame, 99th percentile";
  stream.x_label = "weeds per m\xC2\xB2";
  LineChart window = time_chart(benchmark, result.window, true);
  window.title = "One plan by the number of targets";
  window.x_label = "targets in the window, at 81.2 per m\xC2\xB2";
  page.section("One thread",
               "Left: rolling view, a frame every " + number(benchmark.setup.frame_period_s) +
                   " s, " + number(benchmark.setup.look_ahead_m) +
                   " m of look-ahead; a replan includes the check of the plan. Right: the whole "
                   "window planned from nothing.");
  page.figures({to_svg(stream), to_svg(window)});
  page.section("Stream").table(table_of(result.stream));
  page.section("Window").table(table_of(result.window));
  page.section("Parameters")
      .facts(provenance_facts(benchmark.planner, benchmark.setup, benchmark.sampling, version));
  return page.finish();
}

}  // namespace furrow::experiments
