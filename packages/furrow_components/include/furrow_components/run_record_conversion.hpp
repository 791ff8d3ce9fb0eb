#pragma once

#include <span>
#include <string>

#include "furrow_core/result.hpp"
#include "furrow_geometry/tool_model.hpp"
#include "furrow_ledger/ledger.hpp"
#include "furrow_ledger/run_record.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

/// The input of a ledger. `axes` are those of the tool, in its order. Without ground truth the
/// sprays are those of the drivers, at the positions that they predict.
/// Error kOutOfRange: a decision or event has an unknown value, which the scorer never publishes.
[[nodiscard]] Result<ledger::RunRecord> from_msg(const furrow_msgs::msg::RunRecord& message,
                                                 std::span<const geometry::AxisModel> axes);

/// The account of a run: of the plants of the ground truth, or of the tracks where there is none.
/// `name` is that of a field without ground truth. Errors as ledger::account().
[[nodiscard]] Result<ledger::Ledger> account(const furrow_msgs::msg::RunRecord& message,
                                             const ledger::RunRecord& record,
                                             const std::string& name);

}  // namespace furrow::components
