#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_launch/run_session.hpp"
#include "furrow_ledger/ledger.hpp"

namespace furrow::launch {

/// The files of a report, which OutputFolder::claim() looks for.
[[nodiscard]] std::vector<std::string_view> report_files();

/// What a run tells the user at its end.
struct RunReport {
  ledger::Summary summary;
  std::uint64_t dropped_messages = 0;
  std::vector<std::string> unhealthy;  ///< a line for each component that is not well
};

/// Accounts for the plants of a run and writes summary.json, ledger.csv, map.svg, report.html and,
/// where the field has a place on the earth, as_applied.geojson into `folder`. An interrupted run
/// is marked as such. @pre outcome.record is not null.
[[nodiscard]] Result<RunReport> write_run_report(const RunOutcome& outcome,
                                                 const PreparedGraph& prepared,
                                                 const RunOptions& options,
                                                 const std::filesystem::path& folder);

}  // namespace furrow::launch
