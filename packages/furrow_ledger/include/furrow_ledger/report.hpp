#pragma once

#include <string>

#include "furrow_ledger/ledger.hpp"
#include "furrow_ledger/run_record.hpp"

namespace furrow::ledger {

/// The field from above as an SVG document: strips of the row one below the other, travel to the
/// right, y (left of the robot) up. Plants are to scale and coloured by outcome, routes by axis.
/// Sprays show their footprints to scale. A missed weed carries the initial of its reason.
[[nodiscard]] std::string map_svg(const Ledger& ledger, const RunRecord& record);

/// The run's report as one self-contained HTML document.
[[nodiscard]] std::string report_html(const Ledger& ledger, const RunRecord& record);

}  // namespace furrow::ledger
