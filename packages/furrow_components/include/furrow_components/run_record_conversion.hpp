#pragma once

#include <span>
#include <string>

#include "furrow_core/result.hpp"
#include "furrow_ledger/run_record.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::components {

/// The input of a ledger. `axes` names the axes by their index. kOutOfRange: a decision or event
/// holds a value that is not of its enumeration; the scorer does not publish such a record.
[[nodiscard]] Result<ledger::RunRecord> from_msg(const furrow_msgs::msg::RunRecord& message,
                                                 std::span<const std::string> axes);

}  // namespace furrow::components
