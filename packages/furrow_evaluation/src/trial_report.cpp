#include <array>
#include <nlohmann/json.hpp>

#include "furrow_evaluation/trial_experiment.hpp"
#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/html.hpp"

namespace furrow::evaluation {
namespace {

using Json = nlohmann::ordered_json;
using ledger::fixed;

Json row_json(const TrialRow& row) {
  return {{"region", row.region},
          {"weeds_total", row.weeds_total},
          {"accurate", row.accurate},
          {"partial", row.partial},
          {"missed", row.missed},
          {"missed_vision", row.missed_vision},
          {"missed_planning", row.missed_planning},
          {"crops_total", row.crops_total},
          {"crops_hit", row.crops_hit},
          {"loss_pct", row.loss_pct},
          {"paper_loss_pct", row.paper_loss_pct},
          {"mean_speed_mps", mean_speed_mps(row.way_m, row.time_s)},
          {"area_rate_ha_per_h", area_rate_ha_per_h(row.area_m2, row.time_s)}};
}

std::string percent(std::int64_t part, std::int64_t whole) {
  if (whole == 0) return "-";
  return fixed(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

Json causes_json(const ledger::Summary& summary) {
  Json json = Json::object();
  for (std::size_t i = 0; i < ledger::kReasonCount; ++i) {
    if (summary.missed_by_reason[i] == 0) continue;
    json[std::string(to_string(static_cast<ledger::Reason>(i)))] = summary.missed_by_reason[i];
  }
  return json;
}

Json stretch_json(const TrialStretch& stretch) {
  const ledger::Summary& s = stretch.summary;
  return {{"region", stretch.region.crop ? "crop_weed" : "weed_only"},
          {"field", stretch.region.field},
          {"seed", stretch.seed},
          {"area_m2", stretch.area_m2},
          {"weeds_total", s.weeds_total},
          {"accurate", s.treated_accurate},
          {"partial", s.treated_partial},
          {"missed", s.missed},
          {"missed_by_reason", causes_json(s)},
          {"crops_total", s.crops_total},
          {"crops_hit", s.crops_hit},
          {"mean_speed_mps", mean_speed_mps(stretch.pace.way_m, stretch.pace.time_s)},
          {"least_speed_mps", stretch.pace.least_mps},
          {"area_rate_ha_per_h", area_rate_ha_per_h(stretch.area_m2, stretch.pace.time_s)},
          {"placement_error_p95_mm",
           s.placement_error_p95_mm ? Json(*s.placement_error_p95_mm) : Json(nullptr)}};
}

ledger::ReportTable paper_table(const TrialResult& result) {
  ledger::ReportTable table{
      "",
      {"region", "", "false hits", "weeds", "accurate", "partial", "missed", "missed by vision",
       "by planning", "loss", "m/s"},
      {{"weed-only", "paper", "-", "473", "183", "192", "98", "39", "59", "20.7 %", ""},
       {"crop-weed", "paper", "4 %", "565", "177", "213", "175", "113", "62", "31.0 %", ""},
       {"all", "paper", "4 %", "1038", "360", "405", "273", "152", "121", "26.3 %", ""}}};
  for (const TrialRow& row : result.rows) {
    table.rows.push_back({row.region, "simulated", percent(row.crops_hit, row.crops_total),
                          std::to_string(row.weeds_total), std::to_string(row.accurate),
                          std::to_string(row.partial), std::to_string(row.missed),
                          std::to_string(row.missed_vision), std::to_string(row.missed_planning),
                          fixed(row.loss_pct, 1) + " %",
                          fixed(mean_speed_mps(row.way_m, row.time_s), 2)});
  }
  return table;
}

ledger::ReportTable stretch_table(const TrialResult& result) {
  ledger::ReportTable table{"",
                            {"region", "field", "m2", "weeds", "loss", "crops hit",
                             "placement p95 mm", "m/s", "least m/s", "ha/h", "causes"},
                            {}};
  for (const TrialStretch& stretch : result.stretches) {
    const ledger::Summary& s = stretch.summary;
    std::string causes;
    const Json by_cause = causes_json(s);
    for (const auto& [name, count] : by_cause.items()) {
      causes += (causes.empty() ? "" : ", ") + name + " " + count.dump();
    }
    table.rows.push_back({stretch.region.crop ? "crop-weed" : "weed-only", stretch.region.field,
                          fixed(stretch.area_m2, 1), std::to_string(s.weeds_total),
                          fixed(s.loss_pct, 1) + " %", percent(s.crops_hit, s.crops_total),
                          s.placement_error_p95_mm ? fixed(*s.placement_error_p95_mm, 1) : "-",
                          fixed(mean_speed_mps(stretch.pace.way_m, stretch.pace.time_s), 2),
                          fixed(stretch.pace.least_mps, 2),
                          fixed(area_rate_ha_per_h(stretch.area_m2, stretch.pace.time_s), 2),
                          causes});
  }
  return table;
}

/// What the trial is to reach, what it reached, and of what the rest consists.
ledger::ReportTable goal_table(const TrialResult& result) {
  std::array<std::int64_t, ledger::kReasonCount> missed{};
  for (const TrialStretch& stretch : result.stretches) {
    for (std::size_t i = 0; i < missed.size(); ++i) {
      missed[i] += stretch.summary.missed_by_reason[i];
    }
  }
  const TrialRow& all = result.rows.back();
  const auto causes = [&](const auto& counts) {
    std::string text;
    for (std::size_t i = 0; i < missed.size(); ++i) {
      const auto reason = static_cast<ledger::Reason>(i);
      if (missed[i] == 0 || !counts(reason)) continue;
      text += (text.empty() ? "" : ", ") + std::string(to_string(reason)) + " " +
              percent(missed[i], all.weeds_total);
    }
    return text;
  };
  const std::int64_t treated = all.accurate + all.partial;
  return {
      "",
      {"", "goal", "reached", "paper", "made up of"},
      {{"weeds missed", "at most 10 %", percent(all.missed, all.weeds_total), "26.3 %", ""},
       {"by vision", "", percent(all.missed_vision, all.weeds_total), "14.6 %",
        causes([](ledger::Reason reason) { return ledger::is_vision_loss(reason); })},
       {"by planning", "at most 2 %", percent(all.missed_planning, all.weeds_total), "11.7 %",
        causes([](ledger::Reason reason) { return !ledger::is_vision_loss(reason); })},
       {"accurate, of the treated", "at least 85 %", percent(all.accurate, treated), "47 %", ""},
       {"crops hit", "at most 1 %", percent(all.crops_hit, all.crops_total), "4 %", ""}}};
}

std::string loss_chart(const TrialResult& result) {
  ledger::GroupedBarChart chart{.title = "Weeds missed", .y_label = "% of the region's weeds"};
  ledger::GroupedBarChart::Series ours{.name = "simulated"};
  ledger::GroupedBarChart::Series paper{.name = "paper"};
  for (const TrialRow& row : result.rows) {
    chart.categories.push_back(row.region);
    ours.samples.emplace_back(ledger::Sample{.value = row.loss_pct});
    paper.samples.emplace_back(ledger::Sample{.value = row.paper_loss_pct});
  }
  chart.series = {ours, paper};
  return to_svg(chart);
}

std::string cause_chart(const TrialResult& result) {
  ledger::BarChart chart{.title = "Causes of the loss", .unit = " weeds"};
  chart.decimals = 0;
  for (std::size_t i = 0; i < ledger::kReasonCount; ++i) {
    double count = 0.0;
    for (const TrialStretch& stretch : result.stretches) {
      count += static_cast<double>(stretch.summary.missed_by_reason[i]);
    }
    if (count <= 0.0) continue;
    chart.bars.push_back(
        {.label = std::string(to_string(static_cast<ledger::Reason>(i))), .value = count});
  }
  return to_svg(chart);
}

}  // namespace

std::string to_table(const TrialResult& result) {
  std::vector<std::vector<std::string>> table = {{"region", "weeds", "accurate", "partial",
                                                  "missed", "vision", "planning", "loss %",
                                                  "paper %", "crops", "hit %", "m/s", "ha/h"}};
  for (const TrialRow& row : result.rows) {
    table.push_back({row.region, std::to_string(row.weeds_total), std::to_string(row.accurate),
                     std::to_string(row.partial), std::to_string(row.missed),
                     std::to_string(row.missed_vision), std::to_string(row.missed_planning),
                     fixed(row.loss_pct, 1), fixed(row.paper_loss_pct, 1),
                     std::to_string(row.crops_total),
                     row.crops_total == 0 ? "-"
                                          : fixed(100.0 * static_cast<double>(row.crops_hit) /
                                                      static_cast<double>(row.crops_total),
                                                  1),
                     fixed(mean_speed_mps(row.way_m, row.time_s), 2),
                     fixed(area_rate_ha_per_h(row.area_m2, row.time_s), 2)});
  }
  return text_table(table);
}

std::string to_json(const TrialExperiment& experiment, const TrialResult& result,
                    std::string_view version) {
  Json json = {{"rows", Json::array()}, {"stretches", Json::array()}};
  for (const TrialRow& row : result.rows) json["rows"].push_back(row_json(row));
  for (const TrialStretch& stretch : result.stretches) {
    json["stretches"].push_back(stretch_json(stretch));
  }
  json["seed"] = experiment.seed;
  json["parameters"] = {{"graph", experiment.graph},           {"length_m", experiment.length_m},
                        {"governed", experiment.governed},     {"governing", experiment.governing},
                        {"conditions", experiment.conditions}, {"settings", experiment.settings}};
  json["version"] = version;
  return json.dump(1) + "\n";
}

std::string to_html(const TrialExperiment& experiment, const TrialResult& result,
                    std::string_view version) {
  ledger::HtmlPage page("Field trial", "Closed loop in the simulator, after the paper's trial");
  double area_m2 = 0.0;
  for (const TrialStretch& stretch : result.stretches) area_m2 += stretch.area_m2;
  page.section("What was done",
               "Rendered images go through detector, tracker, fused localization, planner, axes "
               "and nozzles. The wheels slip, the RTK receiver has outages, wind moves spray and "
               "leaves, and the valves jitter. The fields are generated at the densities of the "
               "paper's data sets; they are not its fields. Everything of ours here is simulated. "
               "Each region has its own seed.");
  page.facts({{"area", fixed(area_m2, 1) + " m2"},
              {"graph", experiment.graph},
              {"seed", std::to_string(experiment.seed)},
              {"version", std::string(version)}});
  page.section("Speed",
               experiment.governed
                   ? "The planner asks for the speed at which its axes keep up with the weeds "
                     "ahead, up to the robot's own, and the robot follows. Fewer missed weeds cost "
                     "time. Speeds and area an hour are those within the fields."
                   : "The robot keeps its speed. Speeds and area an hour are those within the "
                     "fields.");
  page.section("The paper's third table beside ours",
               "Accurate: the stem within 10 mm of a spray's centre; partial: within 25 mm.");
  page.table(paper_table(result));
  page.section("What it is to reach",
               "Weeds missed, by what the ledger calls the cause: undetected, unconfirmed and "
               "misclassified are vision's, all else is planning's, the placement of sprays "
               "included. Unreachable: no axis had the time.");
  page.table(goal_table(result));
  page.section("In pictures", "");
  page.figures({loss_chart(result), cause_chart(result)});
  page.section("Stretch by stretch",
               "Causes from the ledger; each stretch has a report of its own beside this one.");
  page.table(stretch_table(result));
  page.section("Footprints over the field", "Paths of the axes, and where sprays landed.");
  for (const TrialStretch& stretch : result.stretches) {
    page.figure(stretch.map_svg, stretch.report);
  }
  return page.finish();
}

}  // namespace furrow::evaluation
