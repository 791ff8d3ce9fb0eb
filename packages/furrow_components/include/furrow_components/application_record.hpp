#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "furrow_actuation/as_applied.hpp"
#include "furrow_core/result.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_ledger/run_record.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

/// The sprays of a run as the drivers report them, in the order of the record. Events of axes that
/// the tool does not have are skipped.
[[nodiscard]] std::vector<actuation::Application> applications_of(
    const furrow_msgs::msg::RunRecord& record, const geometry::ToolModel& tool);

/// Tables for the report: use by nozzle, by crop row and by area, and the safe states of the tool.
[[nodiscard]] std::vector<ledger::ReportTable> use_tables(
    const furrow_msgs::msg::RunRecord& record,
    const std::vector<actuation::Application>& applications, const geometry::ToolModel& tool);

/// Writes as_applied.geojson into a folder, whole or not at all. Writes nothing when the record has
/// no georeference.
[[nodiscard]] Status write_as_applied(const std::filesystem::path& folder,
                                      const furrow_msgs::msg::RunRecord& record,
                                      const std::vector<actuation::Application>& applications);

}  // namespace furrow::components
