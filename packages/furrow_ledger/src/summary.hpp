#pragma once

#include <vector>

#include "furrow_ledger/ledger.hpp"

namespace furrow::ledger {

/// Counts outcomes and reasons, and sets the percentages.
void count_rows(const std::vector<LedgerRow>& rows, Summary& summary);
/// Takes over what the run says of itself.
void take_run_info(const RunInfo& info, Summary& summary);
/// Sets the quantiles from samples in mm, ascending.
void set_errors(const std::vector<double>& placement_mm, const std::vector<double>& aim_mm,
                Summary& summary);

}  // namespace furrow::ledger
