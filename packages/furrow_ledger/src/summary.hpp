#pragma once

#include <vector>

#include "furrow_ledger/ledger.hpp"

namespace furrow::ledger {

/// Linear between the two nearest ranks (Hyndman and Fan 1996, definition 7).
/// @pre sorted is ascending and not empty, fraction in [0, 1].
[[nodiscard]] double quantile(const std::vector<double>& sorted, double fraction);

/// Counts outcomes and reasons, and sets the percentages.
void count_rows(const std::vector<LedgerRow>& rows, Summary& summary);
/// Takes over what the run says of itself.
void take_run_info(const RunInfo& info, Summary& summary);
/// Sets the quantiles from samples in mm, ascending.
void set_errors(const std::vector<double>& placement_mm, const std::vector<double>& aim_mm,
                Summary& summary);

}  // namespace furrow::ledger
