#include "furrow_launch/run_summary.hpp"

#include <array>

#include "furrow_core/text.hpp"

namespace furrow::launch {
namespace {

std::string percent(std::int64_t part, std::int64_t whole) {
  return whole == 0
             ? "-"
             : fixed(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1) + " %";
}

std::string millimetres(const std::optional<double>& value) {
  return value ? fixed(*value, 1) + " mm" : "-";
}

}  // namespace

std::string health_text(std::uint8_t level, const std::string& message) {
  constexpr std::array<const char*, 4> kLevels = {"ok", "warning", "error", "stale"};
  const std::string name = level < kLevels.size() ? kLevels[level] : "unknown";
  return message.empty() ? name : name + ": " + message;
}

std::vector<std::string> not_well(std::span<const graph::ComponentStatus> components) {
  std::vector<std::string> lines;
  for (const graph::ComponentStatus& component : components) {
    const graph::Health& health = component.health;
    if (health.level == graph::HealthLevel::kOk) continue;
    lines.push_back(component.name + ": " +
                    health_text(static_cast<std::uint8_t>(health.level), health.message));
  }
  return lines;
}

std::vector<ledger::ReportTable> health_tables(std::span<const graph::ComponentStatus> components,
                                               bool with_times) {
  ledger::ReportTable table{
      "Components", {"component", "class", "health", "received", "dropped", "counters"}, {}};
  if (with_times) {
    table.header.insert(table.header.end() - 1, {"busy", "longest call", "timers", "missed",
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
    const std::string health =
        health_text(static_cast<std::uint8_t>(component.health.level), component.health.message);
    std::vector<std::string> row = {component.name, component.class_name, health,
                                    std::to_string(received), std::to_string(dropped)};
    if (with_times) {
      row.push_back(fixed(component.busy_s, 2) + " s");
      row.push_back(fixed(1e3 * component.longest_call_s, 1) + " ms");
      row.push_back(std::to_string(component.timers));
      row.push_back(std::to_string(component.missed_timers));
      row.push_back(fixed(1e3 * component.timer_late_p99.to_seconds(), 2) + " ms");
      row.push_back(fixed(1e3 * component.timer_late_max.to_seconds(), 2) + " ms");
      row.push_back(component.thread);
    }
    row.push_back(counters);
    table.rows.push_back(std::move(row));
  }
  return {table};
}

std::string outcome_text(const ledger::Summary& s, std::uint64_t dropped) {
  const std::string how = s.against_truth ? "" : ", computed";
  std::vector<std::vector<std::string>> rows = {
      {"weeds" + std::string(s.against_truth ? "" : " (tracks)"), std::to_string(s.weeds_total),
       ""},
      {"  treated accurately" + how, std::to_string(s.treated_accurate),
       percent(s.treated_accurate, s.weeds_total)},
      {"  treated partially" + how, std::to_string(s.treated_partial),
       percent(s.treated_partial, s.weeds_total)},
      {"  missed" + how, std::to_string(s.missed), percent(s.missed, s.weeds_total)},
  };
  for (std::size_t i = 0; i < ledger::kReasonCount; ++i) {
    if (s.missed_by_reason[i] == 0) continue;
    rows.push_back({"    " + std::string(ledger::to_string(static_cast<ledger::Reason>(i))),
                    std::to_string(s.missed_by_reason[i]),
                    percent(s.missed_by_reason[i], s.weeds_total)});
  }
  rows.push_back({"crops hit" + how,
                  std::to_string(s.crops_hit) + " of " + std::to_string(s.crops_total),
                  percent(s.crops_hit, s.crops_total)});
  rows.push_back({"sprays", std::to_string(s.sprays), ""});
  const auto placement = [&](const std::optional<double>& error_mm) {
    return s.against_truth ? millimetres(error_mm) : "unknown";
  };
  rows.push_back({"placement error p50", placement(s.placement_error_p50_mm), ""});
  rows.push_back({"placement error p95", placement(s.placement_error_p95_mm), ""});
  if (dropped > 0) rows.push_back({"messages dropped", std::to_string(dropped), ""});
  if (s.realtime_factor)
    rows.push_back({"speed of the run", fixed(*s.realtime_factor, 1) + " x real time", ""});
  return text_table(rows);
}

std::uint64_t dropped_messages(std::span<const graph::ComponentStatus> components) {
  std::uint64_t dropped = 0;
  for (const graph::ComponentStatus& component : components) {
    for (const graph::InputStatus& input : component.inputs) dropped += input.dropped;
  }
  return dropped;
}

}  // namespace furrow::launch
