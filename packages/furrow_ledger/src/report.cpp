#include "furrow_ledger/report.hpp"

#include <algorithm>

#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/html.hpp"
#include "furrow_ledger/palette.hpp"
#include "map.hpp"
#include "map_glyphs.hpp"

namespace furrow::ledger {
namespace {

constexpr double kMapLength_m = 100.0;
constexpr std::size_t kMostRows = 500;

std::string count(std::int64_t value) {
  return std::to_string(value);
}
std::string percent(double value) {
  return fixed(value, 1) + " %";
}
std::string millimetres(const std::optional<double>& value) {
  return value ? fixed(*value, 1) + " mm" : "-";
}
std::string share(std::int64_t part, std::int64_t whole) {
  return whole > 0 ? percent(100.0 * static_cast<double>(part) / static_cast<double>(whole)) : "-";
}

std::string radius_mm(double radius_m) {
  return number(radius_m * 1e3, 1) + " mm";
}

std::vector<Tile> headline(const Ledger& ledger) {
  const Summary& s = ledger.summary;
  const std::int64_t treated = s.treated_accurate + s.treated_partial;
  const std::string how = s.against_truth ? "" : ", computed";
  return {
      {"Weeds treated" + how, share(treated, s.weeds_total),
       count(treated) + " of " + count(s.weeds_total), ""},
      {"Treated accurately" + how, share(s.treated_accurate, s.weeds_total),
       count(s.treated_accurate) + " within " + radius_mm(ledger.parameters.accurate_radius_m), ""},
      {"Loss by planning", percent(s.loss_planning_pct), "planning, machine and run",
       std::string(palette::kMissed)},
      {"Loss by vision", s.against_truth ? percent(s.loss_vision_pct) : "unknown",
       s.against_truth ? "not seen, or mistaken" : "needs the true plants",
       std::string(palette::kMissedVision)},
      {"Crops hit" + how, count(s.crops_hit), "of " + count(s.crops_total),
       std::string(palette::kHit)},
      {"Placement error", s.against_truth ? millimetres(s.placement_error_p50_mm) : "unknown",
       s.against_truth ? "median; p95 " + millimetres(s.placement_error_p95_mm)
                       : "needs the true plants",
       ""},
  };
}

BarChart reasons_chart(const Summary& s) {
  BarChart chart;
  chart.title = "Missed weeds by cause";
  chart.decimals = 0;
  for (std::size_t i = 1; i < kReasonCount; ++i) {
    if (s.missed_by_reason[i] == 0) continue;
    const auto reason = static_cast<Reason>(i);
    chart.bars.push_back({std::string(reason_phrase(reason)),
                          static_cast<double>(s.missed_by_reason[i]),
                          std::string(reason_color(reason)),
                          share(s.missed_by_reason[i], s.weeds_total) + " of all weeds"});
  }
  std::stable_sort(chart.bars.begin(), chart.bars.end(),
                   [](const Bar& a, const Bar& b) { return a.value > b.value; });
  return chart;
}

Histogram error_chart(const Ledger& ledger) {
  Histogram chart;
  chart.title = "Placement error of sprays";
  chart.x_label = "mm";
  chart.y_label = "weeds";
  chart.values = ledger.placement_errors_mm;
  chart.bin_width = 1.0;
  chart.x_max = 30.0;
  chart.marks = {{ledger.parameters.accurate_radius_m * 1e3, "accurate"},
                 {ledger.parameters.partial_radius_m * 1e3, "partial"}};
  return chart;
}

std::vector<std::string> axis_charts(const Summary& s) {
  BarChart sprays;
  sprays.title = "Sprays by axis";
  sprays.decimals = 0;
  for (std::size_t i = 0; i < s.sprays_by_axis.size(); ++i) {
    sprays.bars.push_back({"axis " + std::to_string(i + 1),
                           static_cast<double>(s.sprays_by_axis[i]), std::string(axis_color(i)),
                           ""});
  }
  BarChart travel;
  travel.title = "Travel by axis";
  travel.unit = "m";
  for (std::size_t i = 0; i < s.axis_travel_m.size(); ++i) {
    travel.bars.push_back(
        {"axis " + std::to_string(i + 1), s.axis_travel_m[i], std::string(axis_color(i)), ""});
  }
  return {to_svg(sprays), to_svg(travel)};
}

std::string seen_as(const LedgerRow& row) {
  if (!row.seen_probability) return "";
  return row.seen_species + " " + percent(100.0 * *row.seen_probability);
}

ReportTable missed_table(const Ledger& ledger) {
  ReportTable table;
  table.header = {"weed",  "species", "seen as",  "x, m",          "y, m",
                  "cause", "track",   "decision", "spray, mm away"};
  for (const LedgerRow& row : ledger.rows) {
    if (row.kind != field::PlantKind::kWeed || row.outcome != Outcome::kMissed) continue;
    if (table.rows.size() == kMostRows) break;
    table.rows.push_back({count(row.plant_id), row.species, seen_as(row), fixed(row.p_F_m.x(), 2),
                          fixed(row.p_F_m.y(), 2), std::string(reason_phrase(row.reason)),
                          row.track_id ? count(*row.track_id) : "",
                          row.action == Action::kNone ? "" : std::string(to_string(row.action)),
                          row.spray_distance_m ? fixed(*row.spray_distance_m * 1e3, 1) : ""});
  }
  return table;
}

using Facts = std::vector<std::pair<std::string, std::string>>;

Facts summary_facts(const Summary& s) {
  return {{"Weeds", count(s.weeds_total)},
          {"Treated accurately", count(s.treated_accurate)},
          {"Treated in part", count(s.treated_partial)},
          {"Missed", count(s.missed) + " (" + percent(s.loss_pct) + ")"},
          {"Crops", count(s.crops_total)},
          {"Crops hit", count(s.crops_hit)},
          {"Sprays", count(s.sprays)},
          {"Sprays that took no weed", count(s.sprays_without_weed)},
          {"Sprays without a command", count(s.sprays_uncommanded)},
          {"Placement error, median", millimetres(s.placement_error_p50_mm)},
          {"Placement error, p95", millimetres(s.placement_error_p95_mm)},
          {"Spray centre to aim, median", millimetres(s.aim_error_p50_mm)},
          {"Spray centre to aim, p95", millimetres(s.aim_error_p95_mm)},
          {"Tracks", count(s.tracks_total)},
          {"Tracks without a plant", count(s.tracks_without_plant)},
          {"Distance", fixed(s.distance_m, 2) + " m"},
          {"Mean speed", fixed(s.speed_mps, 2) + " m/s"},
          {"Duration", fixed(s.duration_s, 1) + " s"},
          {"Times real time", s.realtime_factor ? fixed(*s.realtime_factor, 2) : "-"}};
}

Facts provenance(const Summary& s, const RunInfo& info) {
  Facts facts = {
      {"Robot and sensors", s.simulated ? "simulated" : "unknown: no ground truth with the data"},
      {"Field", s.field},
      {"Plants from", s.source},
      {"End of the run", s.interrupted ? "interrupted: it ended early" : "finished"},
      {"Outcomes", s.against_truth ? "measured against the true plants"
                                   : "computed from the robot's own tracks"},
      {"Seed", count(s.seed)},
      {"Graph", info.graph},
      {"Version", s.version}};
  facts.insert(facts.end(), info.more.begin(), info.more.end());
  std::erase_if(facts, [](const auto& fact) { return fact.second.empty(); });
  return facts;
}

std::string subtitle(const Summary& s) {
  std::string text = s.simulated ? "Simulated run" : "Run";
  if (s.interrupted) text += ", interrupted";
  text += ", " + fixed(s.distance_m, 1) + " m at " + fixed(s.speed_mps, 2) + " m/s";
  if (!s.source.empty()) text += " \xC2\xB7 " + s.source;
  return text;
}

}  // namespace

std::string report_html(const Ledger& ledger, const RunRecord& record) {
  const Summary& s = ledger.summary;
  HtmlPage page("Weeding " + (s.field.empty() ? std::string("report") : s.field), subtitle(s));
  page.tiles(headline(ledger));

  std::string lead =
      "Seen from above, in strips from top to bottom. Discs are footprints, to scale.";
  if (ledger.length_m > kMapLength_m) {
    lead += " The first " + number(kMapLength_m) + " m; map.svg shows all.";
  }
  page.section("The field", lead).figure(map_svg_part(ledger, record, kMapLength_m));

  const std::string limits = "Accurate: the stem is within " +
                             radius_mm(ledger.parameters.accurate_radius_m) +
                             " of a spray's centre; partial: within " +
                             radius_mm(ledger.parameters.partial_radius_m) + ".";
  page.section("Losses and precision",
               (s.against_truth ? "Every missed weed has one cause. "
                                : "Computed from what the robot itself saw: plants that it never "
                                  "saw do not appear. ") +
                   limits);
  std::vector<std::string> charts = {to_svg(reasons_chart(s)), to_svg(error_chart(ledger))};
  if (!s.sprays_by_axis.empty()) {
    for (std::string& chart : axis_charts(s)) charts.push_back(std::move(chart));
  }
  page.figures(charts);

  page.section("Figures").facts(summary_facts(s));

  if (s.missed > 0) {
    const bool cut = s.missed > static_cast<std::int64_t>(kMostRows);
    page.section("Missed weeds", cut ? "The first " + std::to_string(kMostRows) +
                                           ", in the order of x; ledger.csv lists every plant."
                                     : "In the order of x; ledger.csv lists every plant.");
    page.table(missed_table(ledger));
  }
  if (!record.tables.empty()) {
    page.section("Health");
    for (const ReportTable& table : record.tables) page.table(table);
  }
  page.section("Where this comes from").facts(provenance(s, record.info));
  return page.finish();
}

}  // namespace furrow::ledger
