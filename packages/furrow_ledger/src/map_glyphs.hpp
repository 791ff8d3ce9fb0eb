#pragma once

#include <string>
#include <string_view>

#include "furrow_ledger/ledger.hpp"
#include "furrow_ledger/markup.hpp"

namespace furrow::ledger {

/// One letter for a cause, unique; "?" for undetected.
[[nodiscard]] std::string_view reason_letter(Reason reason);
[[nodiscard]] std::string_view reason_color(Reason reason);
/// "unreachable in time", for people.
[[nodiscard]] std::string_view reason_phrase(Reason reason);

/// The shapes that plants refer to.
void draw_glyph_definitions(Markup& svg);
/// A plant at (x, y) px; `radius_px` to scale, drawn no smaller than can be seen.
void draw_plant(Markup& svg, const LedgerRow& row, double x, double y, double radius_px);
void draw_weed_mark(Markup& svg, Outcome outcome, Reason reason, double x, double y);
void draw_hit_mark(Markup& svg, double x, double y, double radius_px);
/// What the glyphs mean, with how many there are; returns the height it takes.
double draw_map_legend(Markup& svg, const Summary& summary, double left, double top, double width);

}  // namespace furrow::ledger
