#include <algorithm>
#include <map>

#include "furrow_experiments/observation_experiment.hpp"
#include "furrow_experiments/paper_figures.hpp"
#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/html.hpp"
#include "report_parts.hpp"

namespace furrow::experiments {
namespace {

using ledger::fixed;
using ledger::LineChart;
using ledger::number;
using ledger::ReportTable;
using Rows = std::vector<EvaluationRow>;

constexpr double kWidth_px = 600.0;
constexpr const char* kDensityLabel = "weeds per m\xC2\xB2";

ledger::Sample with_ci(const EvaluationRow& row) {
  return {row.loss_pct, std::max(0.0, row.loss_pct - row.loss_ci95), row.loss_pct + row.loss_ci95};
}

LineChart::Series paper_series(bool rolling) {
  LineChart::Series series;
  series.name = rolling ? "paper, rolling view" : "paper, segment view";
  series.color = rolling ? std::string(kPaperColor) : "#a3a3a3";
  series.dashed = true;
  for (const PaperFigures& figures : kPaperFigures) {
    series.points.push_back(
        {figures.weeds_per_m2, {rolling ? figures.rolling_loss_pct : figures.segment_loss_pct}});
  }
  return series;
}

bool of_paper(const Rows& rows) {
  return std::any_of(rows.begin(), rows.end(),
                     [](const EvaluationRow& row) { return row.paper_loss_pct.has_value(); });
}

LineChart loss_chart(const Rows& rows, const std::string& view) {
  LineChart chart;
  chart.title = "Weeds left untreated, " + view + " view";
  chart.x_label = kDensityLabel;
  chart.y_label = "loss, %";
  chart.log_x = true;
  chart.width_px = kWidth_px;
  chart.height_px = 400.0;
  for (const std::string& planner : main_planners(rows)) {
    LineChart::Series series;
    series.name = planner;
    series.color = planner_color(planner);
    for (const EvaluationRow& row : rows) {
      if (row.view == view && planner_name(row) == planner) {
        series.points.push_back({row.weeds_per_m2, with_ci(row)});
      }
    }
    chart.series.push_back(std::move(series));
  }
  if (of_paper(rows)) chart.series.push_back(paper_series(view == "rolling"));
  LineChart::Series optimum;
  optimum.name = "optimum, one spray a weed";
  optimum.color = std::string(kOptimumColor);
  optimum.dashed = true;
  std::map<double, double> by_density;
  for (const EvaluationRow& row : rows) by_density[row.weeds_per_m2] = row.optimum_loss_pct;
  for (const auto& [density, loss] : by_density) optimum.points.push_back({density, {loss}});
  chart.series.push_back(std::move(optimum));
  return chart;
}

/// The row of least loss; of several the last, which is of the better planner.
const EvaluationRow* best_of(const Rows& rows, const std::string& field) {
  const EvaluationRow* best = nullptr;
  for (const EvaluationRow& row : rows) {
    if (row.field == field && (best == nullptr || row.loss_pct <= best->loss_pct)) best = &row;
  }
  return best;
}

std::vector<ledger::Tile> tiles(const Rows& rows) {
  std::vector<ledger::Tile> tiles;
  for (const std::string& field : field_names(rows)) {
    const EvaluationRow* best = best_of(rows, field);
    const std::string paper =
        best->paper_loss_pct ? "; paper " + fixed(*best->paper_loss_pct, 1) + " %" : "";
    tiles.push_back({"Loss at " + number(best->weeds_per_m2, 1) + " weeds/m\xC2\xB2",
                     fixed(best->loss_pct, 1) + " %", planner_name(*best) + paper, ""});
  }
  return tiles;
}

/// Each view beside the other, as in the paper's table.
ReportTable field_table(const Rows& rows, const std::string& field,
                        const std::vector<std::string>& views) {
  ReportTable table;
  table.header = {"planner"};
  for (const std::string& view : views) {
    table.header.insert(table.header.end(),
                        {view + " loss, %", "\xC2\xB1 95 %", "travel, m", "\xC2\xB1 sd"});
  }
  table.header.insert(table.header.end(), {"optimum, %", "bound, %", "sprays/weed",
                                           "p50, \xC2\xB5s", "p99, \xC2\xB5s"});
  if (const PaperFigures* paper = paper_figures(field); paper != nullptr) {
    std::vector<std::string> line = {"paper (nOTSP, " + std::string(paper->field) + ")"};
    for (const std::string& view : views) {
      const bool rolling = view == "rolling";
      line.insert(line.end(),
                  {fixed(rolling ? paper->rolling_loss_pct : paper->segment_loss_pct, 1), "-",
                   fixed(rolling ? paper->rolling_travel_m : paper->segment_travel_m, 1),
                   fixed(rolling ? paper->rolling_travel_sd_m : paper->segment_travel_sd_m, 1)});
    }
    line.insert(line.end(), {"-", "-", "-", "-", "-"});
    table.rows.push_back(std::move(line));
  }
  std::vector<std::string> line;
  for (const EvaluationRow& row : rows) {
    if (row.field != field) continue;
    if (table.title.empty()) table.title = field_title(row);
    if (row.view == views.front()) line = {planner_name(row)};
    line.insert(line.end(), {fixed(row.loss_pct, 2), fixed(row.loss_ci95, 2),
                             fixed(row.travel_m_mean, 1), fixed(row.travel_m_sd, 1)});
    if (row.view != views.back()) continue;
    line.insert(line.end(), {fixed(row.optimum_loss_pct, 2), cell(row.bound_loss_pct, 2),
                             fixed(row.sprays_per_weed, 2), fixed(row.replan_p50_us, 1),
                             fixed(row.replan_p99_us, 1)});
    table.rows.push_back(line);
  }
  return table;
}

ledger::BarChart all_planners_chart(const Rows& rows, const std::string& field,
                                    const std::string& view) {
  ledger::BarChart chart;
  chart.unit = "%";
  for (const EvaluationRow& row : rows) {
    if (row.field != field || row.view != view) continue;
    if (chart.title.empty()) chart.title = "Loss, " + view + " view: " + field_title(row);
    const std::string color = planner_color(planner_name(row));
    chart.bars.push_back({planner_name(row), row.loss_pct, color.empty() ? "#b9c2bb" : color, ""});
  }
  if (const PaperFigures* paper = paper_figures(field); paper != nullptr) {
    const bool rolling = view == "rolling";
    chart.bars.push_back({"paper", rolling ? paper->rolling_loss_pct : paper->segment_loss_pct,
                          std::string(kPaperColor), ""});
  }
  std::stable_sort(chart.bars.begin(), chart.bars.end(),
                   [](const ledger::Bar& a, const ledger::Bar& b) { return a.value > b.value; });
  return chart;
}

ledger::GroupedBarChart travel_chart(const Rows& rows, const std::string& view) {
  ledger::GroupedBarChart chart;
  chart.title = "Travel of an axis, " + view + " view";
  chart.y_label = "m";
  chart.width_px = kWidth_px;
  const auto fields = field_names(rows);
  for (const std::string& field : fields) chart.categories.push_back(field);
  for (const std::string& planner : main_planners(rows)) {
    ledger::GroupedBarChart::Series series{planner, planner_color(planner), {}};
    for (const std::string& field : fields) {
      std::optional<ledger::Sample> sample;
      for (const EvaluationRow& row : rows) {
        if (row.field == field && row.view == view && planner_name(row) == planner) {
          sample = {row.travel_m_mean, std::max(0.0, row.travel_m_mean - row.travel_m_sd),
                    row.travel_m_mean + row.travel_m_sd};
        }
      }
      series.samples.push_back(sample);
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

LineChart sweep_chart(const std::vector<SweepPoint>& points, const std::string& parameter,
                      const std::string& title, const std::string& x_label) {
  LineChart chart;
  chart.title = title;
  chart.x_label = x_label;
  chart.width_px = kWidth_px;
  chart.y_label = "loss, %";
  Rows rows;
  for (const SweepPoint& point : points) rows.push_back(point.row);
  for (const std::string& planner : main_planners(rows)) {
    LineChart::Series series{planner, planner_color(planner), {}, false};
    for (const SweepPoint& point : points) {
      if (point.parameter == parameter && planner_name(point.row) == planner) {
        series.points.push_back({point.value, with_ci(point.row)});
      }
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

void add_sweeps(ledger::HtmlPage& page, const ObservationResult& result) {
  if (result.sweeps.empty()) return;
  const auto& sweeps = result.sweeps;
  page.section("What if", "One figure of the machine changed at a time, rolling view, " +
                              field_title(sweeps.front().row) + ", " +
                              number(static_cast<double>(result.sweep_seeds)) +
                              " fields for each point. Bars: 95 % confidence intervals.");
  page.figures({to_svg(sweep_chart(sweeps, "speed_mps", "Robot speed", "m/s")),
                to_svg(sweep_chart(sweeps, "axes", "Number of axes", "axes")),
                to_svg(sweep_chart(sweeps, "axis_velocity_mps", "Axis velocity", "m/s")),
                to_svg(sweep_chart(sweeps, "omega",
                                   "Steepness of the feasibility: a small omega waits longer",
                                   "omega, 1/s"))});
}

void add_routes(ledger::HtmlPage& page, const ObservationResult& result) {
  if (result.routes.empty()) return;
  page.section(
      "One stretch of row, planner beside planner",
      "Travel to the right. A colour is an axis, discs are spray footprints to scale; dots "
      "are weeds that were treated, rings are weeds that were missed.");
  std::vector<std::string> figures;
  for (const RouteExample& example : result.routes) figures.push_back(to_svg(example));
  page.figures(figures);
}

}  // namespace

std::string to_html(const ObservationExperiment& experiment, const ObservationResult& result,
                    std::string_view version) {
  const Rows& rows = result.rows;
  ledger::HtmlPage page(
      "Loss and travel by weed density",
      conditions(experiment.planner, experiment.setup, experiment.sampling, experiment.fields));
  page.tiles(tiles(rows));
  const bool paper = of_paper(rows);
  page.section("Loss against density",
               std::string("Bars are 95 % confidence intervals over seeds. ") +
                   (paper ? "Dashed, hollow: the paper's figures (nOTSP, static division), and "
                            "the best plan with one spray for each weed when the whole row is "
                            "known beforehand. The paper's fields were recorded and are not at "
                            "hand; ours are generated at their densities. Footprints that take "
                            "several weeds can do better than the best plan."
                          : "Dashed, hollow: the best plan with one spray for each weed when the "
                            "whole row is known beforehand."));
  std::vector<std::string> charts;
  for (auto view = experiment.views.rbegin(); view != experiment.views.rend(); ++view) {
    charts.push_back(to_svg(loss_chart(rows, *view)));
  }
  page.figures(charts);

  add_routes(page, result);

  page.section("Every planner", "Grey: divisions of the work that the charts above leave out.");
  std::vector<std::string> bars;
  const auto fields = field_names(rows);
  for (std::size_t f = fields.size() > 2 ? fields.size() - 2 : 0; f < fields.size(); ++f) {
    bars.push_back(to_svg(all_planners_chart(rows, fields[f], experiment.views.back())));
  }
  page.figures(bars);

  page.section("Travel", "Mean over axes and seeds; bars are the standard deviation.");
  std::vector<std::string> travels;
  for (auto view = experiment.views.rbegin(); view != experiment.views.rend(); ++view) {
    travels.push_back(to_svg(travel_chart(rows, *view)));
  }
  page.figures(travels);

  add_sweeps(page, result);

  page.section(
      "Tables",
      "Loss: weeds left untreated. Optimum: of one spray for each weed, the whole row known. "
      "Bound: "
      "what no placement of footprints at all can treat; the gap to it is the most that any plan "
      "could still gain. Travel: of one axis over the whole row. p50, p99: time of "
      "one plan in the last view, measured while other drives ran beside it.");
  for (const std::string& field : fields) page.table(field_table(rows, field, experiment.views));
  if (paper) {
    page.paragraph(
        "Paper: Ahmadi, Halstead, Smitt, McCool, BonnBot-I Plus (2024), arXiv 2405.09118, table of "
        "weeding performance. It does not say how long its rows are, so that travel does not "
        "compare directly.");
  }
  page.section("Parameters")
      .facts(provenance_facts(experiment.planner, experiment.setup, experiment.sampling, version));
  return page.finish();
}

}  // namespace furrow::experiments
