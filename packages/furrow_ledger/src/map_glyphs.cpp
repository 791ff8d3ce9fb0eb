#include "map_glyphs.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "chart_frame.hpp"
#include "furrow_ledger/palette.hpp"

namespace furrow::ledger {
namespace {

struct ReasonText {
  std::string_view letter;
  std::string_view phrase;
};
constexpr std::array<ReasonText, kReasonCount> kReasons = {{{"", ""},
                                                            {"?", "not detected"},
                                                            {"U", "not confirmed"},
                                                            {"M", "taken for a crop"},
                                                            {"L", "left on purpose"},
                                                            {"C", "protected crop"},
                                                            {"R", "not reached in time"},
                                                            {"S", "stale data"},
                                                            {"O", "outside the reach"},
                                                            {"F", "fault"},
                                                            {"P", "spray misplaced"},
                                                            {"E", "end of the run"},
                                                            {"I", "tool raised or off"},
                                                            {"A", "may be a crop"}}};

/// Leaves around a stem, in a circle of radius 1.
void draw_rosette(Markup& svg, std::string_view id, int leaves, double width) {
  svg.open("g", {{"id", std::string(id)}});
  for (int i = 0; i < leaves; ++i) {
    svg.empty("ellipse", {{"cx", "0.54"},
                          {"rx", "0.46"},
                          {"ry", px(width)},
                          {"transform", "rotate(" + px(360.0 * i / leaves) + ")"}});
  }
  svg.close();
}

void draw_use(Markup& svg, std::string_view id, double x, double y, double radius, double turn_deg,
              std::string_view color) {
  svg.empty("use", {{"href", "#" + std::string(id)},
                    {"transform", "translate(" + px(x) + " " + px(y) + ") scale(" + px(radius) +
                                      ") rotate(" + number(turn_deg, 0) + ")"},
                    {"fill", std::string(color)}});
}

std::string description(const LedgerRow& row) {
  std::string text = std::string(to_string(row.kind)) + " " + std::to_string(row.plant_id);
  if (!row.species.empty()) text += ", " + row.species;
  text += ": " + std::string(to_string(row.outcome));
  if (row.reason != Reason::kNone) text += ", " + std::string(reason_phrase(row.reason));
  if (row.spray_distance_m) text += ", spray " + fixed(*row.spray_distance_m * 1e3, 1) + " mm away";
  return text + " (x " + fixed(row.p_F_m.x(), 2) + " m, y " + fixed(row.p_F_m.y(), 2) + " m)";
}

}  // namespace

std::string_view reason_letter(Reason reason) {
  return kReasons.at(static_cast<std::size_t>(reason)).letter;
}
std::string_view reason_phrase(Reason reason) {
  return kReasons.at(static_cast<std::size_t>(reason)).phrase;
}
std::string_view reason_color(Reason reason) {
  if (reason == Reason::kLowPriority) return palette::kLeft;
  return is_vision_loss(reason) ? palette::kMissedVision : palette::kMissed;
}

void draw_glyph_definitions(Markup& svg) {
  svg.open("defs");
  draw_rosette(svg, "furrow-crop", 6, 0.24);
  draw_rosette(svg, "furrow-weed", 4, 0.22);
  svg.close();
}

void draw_weed_mark(Markup& svg, Outcome outcome, Reason reason, double x, double y) {
  if (outcome == Outcome::kMissed) {
    svg.empty("circle", {{"cx", px(x)},
                         {"cy", px(y)},
                         {"r", "5.6"},
                         {"fill", std::string(reason_color(reason))},
                         {"stroke", "#ffffff"},
                         {"stroke-width", "0.8"}});
    draw_text(svg, x, y + 2.9, reason_letter(reason), "middle", "#ffffff", 8, "700");
    return;
  }
  const bool accurate = outcome == Outcome::kAccurate;
  svg.empty("circle", {{"cx", px(x)},
                       {"cy", px(y)},
                       {"r", accurate ? "2" : "2.2"},
                       {"fill", accurate ? std::string(palette::kInk) : "#ffffff"},
                       {"stroke", std::string(palette::kInk)},
                       {"stroke-width", accurate ? "0" : "1.3"}});
}

void draw_hit_mark(Markup& svg, double x, double y, double radius_px) {
  const double r = std::max(radius_px, 8.0);
  svg.empty("circle", {{"cx", px(x)},
                       {"cy", px(y)},
                       {"r", px(r)},
                       {"fill", "none"},
                       {"stroke", std::string(palette::kHit)},
                       {"stroke-width", "2"}});
  draw_line(svg, x - 4, y - 4, x + 4, y + 4, palette::kHit, 2);
  draw_line(svg, x - 4, y + 4, x + 4, y - 4, palette::kHit, 2);
}

void draw_plant(Markup& svg, const LedgerRow& row, double x, double y, double radius_px) {
  svg.open("g");
  svg.element("title", description(row));
  // A fixed turn for each plant, so that a row does not look stamped.
  const double turn_deg = static_cast<double>((row.plant_id % 17 + 17) % 17) * 37.0;
  if (row.kind == field::PlantKind::kCrop) {
    const double r = std::max(radius_px, 5.0);
    draw_use(svg, "furrow-crop", x, y, r, turn_deg, palette::kCrop);
    if (row.outcome == Outcome::kHit) draw_hit_mark(svg, x, y, 0.6 * r);
  } else {
    const double r = std::max(radius_px, 4.0);
    draw_use(svg, "furrow-weed", x, y, r, turn_deg,
             row.outcome == Outcome::kMissed ? reason_color(row.reason) : palette::kTreated);
    draw_weed_mark(svg, row.outcome, row.reason, x, y);
  }
  svg.close();
}

double draw_map_legend(Markup& svg, const Summary& summary, double left, double top, double width) {
  constexpr double kLine_px = 22.0;
  double x = left;
  double y = top + 8;
  const auto entry = [&](const std::string& name,
                         const std::function<void(double, double)>& glyph) {
    const double needed = 18 + text_width_px(name) + 20;
    if (x > left && x + needed > left + width) {
      x = left;
      y += kLine_px;
    }
    glyph(x + 7, y);
    draw_text(svg, x + 20, y + 4, name, "start", palette::kInk);
    x += needed;
  };
  const auto weed = [&](Outcome outcome, Reason reason) {
    return [&svg, outcome, reason](double at_x, double at_y) {
      draw_use(svg, "furrow-weed", at_x, at_y, 8, 45,
               outcome == Outcome::kMissed ? reason_color(reason) : palette::kTreated);
      draw_weed_mark(svg, outcome, reason, at_x, at_y);
    };
  };
  entry("crop (" + std::to_string(summary.crops_total) + ")", [&](double at_x, double at_y) {
    draw_use(svg, "furrow-crop", at_x, at_y, 9, 0, palette::kCrop);
  });
  entry("crop hit (" + std::to_string(summary.crops_hit) + ")", [&](double at_x, double at_y) {
    draw_use(svg, "furrow-crop", at_x, at_y, 9, 0, palette::kCrop);
    draw_hit_mark(svg, at_x, at_y, 8);
  });
  entry("weed treated accurately (" + std::to_string(summary.treated_accurate) + ")",
        weed(Outcome::kAccurate, Reason::kNone));
  entry("treated in part (" + std::to_string(summary.treated_partial) + ")",
        weed(Outcome::kPartial, Reason::kNone));
  for (std::size_t i = 1; i < kReasonCount; ++i) {
    if (summary.missed_by_reason[i] == 0) continue;
    const auto reason = static_cast<Reason>(i);
    entry("missed: " + std::string(reason_phrase(reason)) + " (" +
              std::to_string(summary.missed_by_reason[i]) + ")",
          weed(Outcome::kMissed, reason));
  }
  for (std::size_t axis = 0; axis < summary.sprays_by_axis.size(); ++axis) {
    entry("axis " + std::to_string(axis + 1) + " (" + std::to_string(summary.sprays_by_axis[axis]) +
              " sprays)",
          [&](double at_x, double at_y) {
            draw_line(svg, at_x - 9, at_y + 5, at_x + 9, at_y - 5, axis_color(axis), 1.6);
            svg.empty("circle", {{"cx", px(at_x)},
                                 {"cy", px(at_y)},
                                 {"r", "6"},
                                 {"fill", std::string(axis_color(axis))},
                                 {"fill-opacity", "0.25"},
                                 {"stroke", std::string(axis_color(axis))}});
          });
  }
  return y + kLine_px - top;
}

}  // namespace furrow::ledger
