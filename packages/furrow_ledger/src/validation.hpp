#pragma once

#include "furrow_ledger/ledger.hpp"

namespace furrow::ledger {

/// kInvalidArgument with what is wrong, or ok.
[[nodiscard]] Status validate(const field::FieldModel& truth, const RunRecord& record,
                              const AccountParameters& parameters);

}  // namespace furrow::ledger
