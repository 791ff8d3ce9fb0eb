#pragma once

#include <string>

#include "furrow_ledger/ledger.hpp"

namespace furrow::ledger {

/// As map_svg, of the first `max_length_m` of the field only.
[[nodiscard]] std::string map_svg_part(const Ledger& ledger, const RunRecord& record,
                                       double max_length_m);

}  // namespace furrow::ledger
