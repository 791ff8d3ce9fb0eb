#include "furrow_launch/run_report.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "furrow_components/application_record.hpp"
#include "furrow_components/run_record_conversion.hpp"
#include "furrow_core/version.hpp"
#include "furrow_launch/diagnostics_table.hpp"
#include "furrow_launch/run_summary.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::launch {
namespace {

/// The name of a field without ground truth.
std::string field_name(const RunOptions& options) {
  return options.recordings.empty()
             ? options.graph
             : std::filesystem::path(options.recordings.front()).stem().string();
}

/// What every nozzle passed over, along the row. A run that was interrupted leaves the weeds ahead
/// of it untouched: they are no losses of vision or planning.
std::pair<double, double> passed_x_m(const std::vector<ledger::RouteView>& routes) {
  constexpr double kFarBack_m = std::numeric_limits<double>::lowest();
  std::optional<double> least_m;
  for (const ledger::RouteView& route : routes) {
    if (route.p_F_m.empty()) continue;
    double farthest_m = kFarBack_m;
    for (const Eigen::Vector2d& p_F : route.p_F_m) farthest_m = std::max(farthest_m, p_F.x());
    least_m = std::min(least_m.value_or(farthest_m), farthest_m);
  }
  return {kFarBack_m, least_m.value_or(kFarBack_m)};
}

ledger::RunInfo run_info(const RunOutcome& outcome, const PreparedGraph& prepared,
                         const RunOptions& options, ledger::RunInfo info) {
  info.simulated = outcome.record->ground_truth();
  info.interrupted = outcome.interrupted;
  info.seed = options.seed;
  info.version = version();
  info.graph = prepared.spec.name;
  info.wall_s = outcome.wall_s;
  info.more = {{"clock", options.clock},
               {"messages dropped", std::to_string(dropped_messages(outcome.components))}};
  return info;
}

}  // namespace

std::vector<std::string_view> report_files() {
  return {"summary.json", "ledger.csv", "report.html", "map.svg", "as_applied.geojson"};
}

Result<RunReport> write_run_report(const RunOutcome& outcome, const PreparedGraph& prepared,
                                   const RunOptions& options, const std::filesystem::path& folder) {
  const furrow_msgs::msg::RunRecord& message = *outcome.record;
  const geometry::ToolModel& tool = prepared.tool;
  const auto applications = components::applications_of(message, tool);
  // First: what was sprayed is known, whatever the account of the plants comes to.
  if (Status written = components::write_as_applied(folder, message, applications); !written) {
    return written.error();
  }
  RunReport report;
  report.dropped_messages = dropped_messages(outcome.components);
  report.unhealthy = not_well(outcome.components);
  auto converted = components::from_msg(message, tool.axes);
  if (!converted.ok()) {
    return Error{converted.error().code, "run/record: " + converted.error().message};
  }
  ledger::RunRecord record = std::move(converted).value();
  record.info = run_info(outcome, prepared, options, std::move(record.info));
  if (outcome.interrupted) record.info.passed_x_m = passed_x_m(record.routes);
  record.tables = components::use_tables(message, applications, tool);
  std::ranges::move(health_tables(outcome.components, !options.lockstep()),
                    std::back_inserter(record.tables));
  if (!outcome.diagnostics.empty()) {
    record.tables.push_back(diagnostics_table(outcome.diagnostics, outcome.process));
    std::ranges::move(not_well(outcome.diagnostics, outcome.process),
                      std::back_inserter(report.unhealthy));
  }
  const auto ledger = components::account(message, record, field_name(options));
  if (!ledger.ok()) {
    return Error{ledger.error().code, "the run cannot be accounted for: " + ledger.error().message};
  }
  if (Status written = ledger::write_run_files(folder, *ledger, record); !written) {
    return written.error();
  }
  report.summary = ledger->summary;
  return report;
}

}  // namespace furrow::launch
