#include <algorithm>
#include <cmath>

#include "furrow_experiments/biodiversity_experiment.hpp"
#include "furrow_experiments/paper_figures.hpp"
#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/html.hpp"
#include "report_parts.hpp"

namespace furrow::experiments {
namespace {

using ledger::fixed;
using ledger::LineChart;
using ledger::number;
using Rows = std::vector<EvaluationRow>;

/// One planner and view on one field, under both schemes.
struct Pair {
  const EvaluationRow* plain = nullptr;
  const EvaluationRow* biodiversity = nullptr;

  [[nodiscard]] double cost_points() const { return biodiversity->loss_pct - plain->loss_pct; }
};

std::vector<Pair> pairs_of(const Rows& rows) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i + 1 < rows.size(); i += 2) pairs.push_back({&rows[i], &rows[i + 1]});
  return pairs;
}

std::string paper_text(const std::optional<double>& value) {
  return value ? "; paper " + fixed(*value, 1) + " %" : "";
}

std::vector<ledger::Tile> tiles(const std::vector<Pair>& pairs, const Rows& rows) {
  std::vector<ledger::Tile> tiles;
  for (const std::string& field : field_names(rows)) {
    const Pair* best = nullptr;
    for (const Pair& pair : pairs) {
      if (pair.plain->field == field &&
          (best == nullptr || pair.biodiversity->loss_pct <= best->biodiversity->loss_pct)) {
        best = &pair;
      }
    }
    const auto& priorities = *best->biodiversity->priorities;
    tiles.push_back(
        {"High priority at " + number(best->plain->weeds_per_m2, 1) + " weeds/m\xC2\xB2",
         fixed(priorities.treated_high_pct, 1) + " %",
         planner_name(*best->plain) + paper_text(priorities.paper_high_pct), ""});
  }
  return tiles;
}

LineChart high_chart(const Rows& rows, const std::string& view, bool high) {
  LineChart chart;
  chart.title = std::string(high ? "High" : "Low") + "-priority weeds treated, " + view + " view";
  chart.x_label = "weeds per m\xC2\xB2";
  chart.y_label = "treated, %";
  chart.log_x = true;
  chart.width_px = 600.0;
  chart.height_px = 380.0;
  for (const std::string& planner : main_planners(rows)) {
    LineChart::Series series{planner, planner_color(planner), {}, false};
    for (const EvaluationRow& row : rows) {
      if (row.view != view || planner_name(row) != planner ||
          row.priorities->scheme != "biodiversity") {
        continue;
      }
      series.points.push_back(
          {row.weeds_per_m2,
           {high ? row.priorities->treated_high_pct : row.priorities->treated_low_pct}});
    }
    chart.series.push_back(std::move(series));
  }
  LineChart::Series paper{"paper", std::string(kPaperColor), {}, true};
  for (const PaperFigures& figures : kPaperFigures) {
    paper.points.push_back({figures.weeds_per_m2,
                            {high ? figures.high_biodiversity_pct : figures.low_biodiversity_pct}});
  }
  chart.series.push_back(std::move(paper));
  return chart;
}

/// Both schemes and priorities by density.
ledger::GroupedBarChart share_chart(const Rows& rows, const std::string& planner,
                                    const std::string& view) {
  ledger::GroupedBarChart chart;
  chart.title = planner + ", " + view + " view";
  chart.y_label = "treated, %";
  chart.width_px = 600.0;
  const auto fields = field_names(rows);
  chart.categories = fields;
  for (const bool high : {true, false}) {
    for (const std::string scheme : {"plain", "biodiversity"}) {
      ledger::GroupedBarChart::Series series;
      series.name = std::string(high ? "high" : "low") + ", " + scheme;
      series.color = high ? (scheme == "plain" ? "#f2b48f" : "#d55e00")
                          : (scheme == "plain" ? "#a9c9de" : "#0072b2");
      for (const std::string& field : fields) {
        std::optional<ledger::Sample> sample;
        for (const EvaluationRow& row : rows) {
          if (row.field == field && row.view == view && planner_name(row) == planner &&
              row.priorities->scheme == scheme) {
            sample = ledger::Sample{high ? row.priorities->treated_high_pct
                                         : row.priorities->treated_low_pct};
          }
        }
        series.samples.push_back(sample);
      }
      chart.series.push_back(std::move(series));
    }
  }
  return chart;
}

LineChart cost_chart(const std::vector<Pair>& pairs, const Rows& rows, const std::string& view) {
  LineChart chart;
  chart.title = "Cost in weeds treated, " + view + " view";
  chart.x_label = "weeds per m\xC2\xB2";
  chart.y_label = "points";
  chart.log_x = true;
  chart.width_px = 600.0;
  for (const std::string& planner : main_planners(rows)) {
    LineChart::Series series{planner, planner_color(planner), {}, false};
    for (const Pair& pair : pairs) {
      if (pair.plain->view != view || planner_name(*pair.plain) != planner) continue;
      series.points.push_back({pair.plain->weeds_per_m2, {pair.cost_points()}});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

ledger::GroupedBarChart paper_chart() {
  ledger::GroupedBarChart chart;
  chart.title = "paper (nOTSP, static division)";
  chart.y_label = "treated, %";
  chart.width_px = 600.0;
  ledger::GroupedBarChart::Series high_plain{"high, plain", "#f2b48f", {}};
  ledger::GroupedBarChart::Series high{"high, biodiversity", "#d55e00", {}};
  ledger::GroupedBarChart::Series low_plain{"low, plain", "#a9c9de", {}};
  ledger::GroupedBarChart::Series low{"low, biodiversity", "#0072b2", {}};
  for (const PaperFigures& figures : kPaperFigures) {
    chart.categories.emplace_back(figures.field);
    high_plain.samples.push_back(ledger::Sample{figures.high_plain_pct});
    high.samples.push_back(ledger::Sample{figures.high_biodiversity_pct});
    low_plain.samples.push_back(ledger::Sample{figures.low_plain_pct});
    low.samples.push_back(ledger::Sample{figures.low_biodiversity_pct});
  }
  chart.series = {high_plain, high, low_plain, low};
  return chart;
}

ledger::ReportTable field_table(const std::vector<Pair>& pairs, const std::string& field) {
  ledger::ReportTable table;
  table.header = {
      "planner",          "view",          "low plain, %",    "low biodiv., %", "high plain, %",
      "high biodiv., %",  "loss plain, %", "loss biodiv., %", "cost, points",   "travel plain, m",
      "travel biodiv., m"};
  if (const PaperFigures* paper = paper_figures(field); paper != nullptr) {
    table.rows.push_back({"paper (" + std::string(paper->field) + ")", "-",
                          fixed(paper->low_plain_pct, 1), fixed(paper->low_biodiversity_pct, 1),
                          fixed(paper->high_plain_pct, 1), fixed(paper->high_biodiversity_pct, 1),
                          "-", "-", "-", "-", "-"});
  }
  for (const Pair& pair : pairs) {
    if (pair.plain->field != field) continue;
    if (table.title.empty()) table.title = field_title(*pair.plain);
    const auto& plain = *pair.plain->priorities;
    const auto& biodiversity = *pair.biodiversity->priorities;
    table.rows.push_back({planner_name(*pair.plain), pair.plain->view,
                          fixed(plain.treated_low_pct, 1), fixed(biodiversity.treated_low_pct, 1),
                          fixed(plain.treated_high_pct, 1), fixed(biodiversity.treated_high_pct, 1),
                          fixed(pair.plain->loss_pct, 2), fixed(pair.biodiversity->loss_pct, 2),
                          fixed(pair.cost_points(), 2), fixed(pair.plain->travel_m_mean, 1),
                          fixed(pair.biodiversity->travel_m_mean, 1)});
  }
  return table;
}

}  // namespace

std::string to_html(const BiodiversityExperiment& experiment, const BiodiversityResult& result,
                    std::string_view version) {
  const Rows& rows = result.rows;
  const std::vector<Pair> pairs = pairs_of(rows);
  ledger::HtmlPage page(
      "Treatment by priority",
      conditions(experiment.planner, experiment.setup, experiment.sampling, experiment.fields));
  page.tiles(tiles(pairs, rows));
  page.section(
      "By density",
      "Planned with weight 1.0 for weeds of high priority and 0.1 for those of low, one to "
      "ten. Dashed: the paper's biodiversity scheme; it treats less even where weeds are "
      "far apart, for a reason that it does not give.");
  std::vector<std::string> shares;
  for (auto view = experiment.views.rbegin(); view != experiment.views.rend(); ++view) {
    shares.push_back(to_svg(high_chart(rows, *view, true)));
    shares.push_back(to_svg(high_chart(rows, *view, false)));
  }
  page.figures(shares);
  page.section("What it costs",
               "How many points of all weeds are lost more when the weights are set. Rolling and "
               "segment view; the scheme asks for weeds of high priority, the total pays.");
  std::vector<std::string> costs;
  for (auto view = experiment.views.rbegin(); view != experiment.views.rend(); ++view) {
    costs.push_back(to_svg(cost_chart(pairs, rows, *view)));
  }
  page.figures(costs);

  page.section("Plain against biodiversity", "Plain: all weeds weigh the same.");
  std::vector<std::string> charts;
  for (const std::string& planner : main_planners(rows)) {
    for (auto view = experiment.views.rbegin(); view != experiment.views.rend(); ++view) {
      charts.push_back(to_svg(share_chart(rows, planner, *view)));
    }
  }
  charts.push_back(to_svg(paper_chart()));
  page.figures(charts);

  page.section(
      "Tables",
      "Shares are of all weeds of a priority over all seeds. Cost: what the weights add to "
      "the loss over all weeds, in points.");
  for (const std::string& field : field_names(rows)) page.table(field_table(pairs, field));
  page.paragraph(
      "Paper: Ahmadi, Halstead, Smitt, McCool, BonnBot-I Plus (2024), arXiv 2405.09118, table of "
      "treatment by weed category.");
  page.section("Parameters")
      .facts(provenance_facts(experiment.planner, experiment.setup, experiment.sampling, version));
  return page.finish();
}

}  // namespace furrow::experiments
