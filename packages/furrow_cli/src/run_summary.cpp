#include "run_summary.hpp"

#include "console.hpp"

namespace furrow::cli {
namespace {

std::string level_name(graph::HealthLevel level) {
  switch (level) {
    case graph::HealthLevel::kOk:
      return "ok";
    case graph::HealthLevel::kWarn:
      return "warning";
    case graph::HealthLevel::kError:
      return "error";
    case graph::HealthLevel::kStale:
      break;
  }
  return "stale";
}

std::string percent(std::int64_t part, std::int64_t whole) {
  return whole == 0
             ? "-"
             : number(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

std::string millimetres(const std::optional<double>& value) {
  return value ? number(*value, 1) + " mm" : "-";
}

}  // namespace

std::vector<ledger::ReportTable> health_tables(std::span<const graph::ComponentStatus> components,
                                               bool with_times) {
  ledger::ReportTable health{
      "Components", {"component", "class", "health", "received", "dropped", "counters"}, {}};
  if (with_times) {
    health.header.insert(health.header.end() - 1, {"busy", "longest call", "timers", "missed",
                                                   "late p99", "late max", "thread"});
  }
  for (const graph::ComponentStatus& component : components) {
    std::uint64_t received = 0;
    std::uint64_t dropped = 0;
    for (const graph::InputStatus& input : component.inputs) {
      received += input.received;
      dropped += input.dropped;
    }
    std::string counters;
    for (const auto& [name, count] : component.health.counters) {
      counters += (counters.empty() ? "" : ", ") + name + " " + std::to_string(count);
    }
    std::string level = level_name(component.health.level);
    if (!component.health.message.empty()) level += ": " + component.health.message;
    std::vector<std::string> row = {component.name, component.class_name, level,
                                    std::to_string(received), std::to_string(dropped)};
    if (with_times) {
      row.push_back(number(component.busy_s, 2) + " s");
      row.push_back(number(1e3 * component.longest_call_s, 1) + " ms");
      row.push_back(std::to_string(component.timers));
      row.push_back(std::to_string(component.missed_timers));
      row.push_back(number(1e3 * component.timer_late_p99.to_seconds(), 2) + " ms");
      row.push_back(number(1e3 * component.timer_late_max.to_seconds(), 2) + " ms");
      row.push_back(component.thread);
    }
    row.push_back(counters);
    health.rows.push_back(std::move(row));
  }
  return {health};
}

std::string outcome_text(const ledger::Summary& s, std::uint64_t dropped) {
  std::vector<std::vector<std::string>> rows = {
      {"weeds", std::to_string(s.weeds_total), ""},
      {"  treated accurately", std::to_string(s.treated_accurate),
       percent(s.treated_accurate, s.weeds_total)},
      {"  treated partially", std::to_string(s.treated_partial),
       percent(s.treated_partial, s.weeds_total)},
      {"  missed", std::to_string(s.missed), percent(s.missed, s.weeds_total)},
  };
  for (std::size_t i = 0; i < ledger::kReasonCount; ++i) {
    if (s.missed_by_reason[i] == 0) continue;
    rows.push_back({"    " + std::string(ledger::to_string(static_cast<ledger::Reason>(i))),
                    std::to_string(s.missed_by_reason[i]),
                    percent(s.missed_by_reason[i], s.weeds_total)});
  }
  rows.push_back({"crops hit", std::to_string(s.crops_hit) + " of " + std::to_string(s.crops_total),
                  percent(s.crops_hit, s.crops_total)});
  rows.push_back({"sprays", std::to_string(s.sprays), ""});
  rows.push_back({"placement error p50", millimetres(s.placement_error_p50_mm), ""});
  rows.push_back({"placement error p95", millimetres(s.placement_error_p95_mm), ""});
  if (dropped > 0) rows.push_back({"messages dropped", std::to_string(dropped), ""});
  if (s.realtime_factor)
    rows.push_back({"speed of the run", number(*s.realtime_factor, 1) + " x real time", ""});
  return text_table(rows);
}

std::uint64_t dropped_messages(std::span<const graph::ComponentStatus> components) {
  std::uint64_t dropped = 0;
  for (const graph::ComponentStatus& component : components) {
    for (const graph::InputStatus& input : component.inputs) dropped += input.dropped;
  }
  return dropped;
}

}  // namespace furrow::cli
