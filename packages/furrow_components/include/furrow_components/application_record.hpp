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

/// The sprays of a run as the drivers made them, in the order of the record. Events of axes that
/// the tool does not have are left out.
[[nodiscard]] std::vector<actuation::Application> applications_of(
    const furrow_msgs::msg::RunRecord& record, const geometry::ToolModel& tool);

/// What the run used and where, for its report: by nozzle, by crop row, by area; and when a tool
/// made itself safe, when it did.
[[nodiscard]] std::vector<ledger::ReportTable> use_tables(
    const furrow_msgs::msg::RunRecord& record,
    const std::vector<actuation::Application>& applications, const geometry::ToolModel& tool);

/// as_applied.geojson into a folder, whole or not at all; nothing when the record does not say
/// where on the earth the field is.
[[nodiscard]] Status write_as_applied(const std::filesystem::path& folder,
                                      const furrow_msgs::msg::RunRecord& record,
                                      const std::vector<actuation::Application>& applications);

}  // namespace furrow::components
