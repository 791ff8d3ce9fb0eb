#include "map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "chart_frame.hpp"
#include "furrow_ledger/palette.hpp"
#include "furrow_ledger/report.hpp"
#include "map_glyphs.hpp"
#include "map_layout.hpp"

namespace furrow::ledger {
namespace {

constexpr double kWidth_px = MapLayout::kWidth_px;
using Layout = MapLayout;

void draw_strip_ground(Markup& svg, const Layout& layout, int strip, const Ledger& ledger,
                       const RunInfo& info) {
  const double from_m = layout.from_m + strip * layout.strip_m;
  const double to_m = std::min(from_m + layout.strip_m, layout.to_m);
  const double left = layout.x_px(strip, from_m);
  const double right = layout.x_px(strip, to_m);
  const double top = layout.strip_top_px(strip);
  const double height = layout.strip_height_px();
  const auto band = [&](double y_top, double y_bottom, std::string_view fill, double radius) {
    svg.empty("rect", {{"x", px(left)},
                       {"y", px(y_top)},
                       {"width", px(right - left)},
                       {"height", px(std::max(y_bottom - y_top, 0.0))},
                       {"rx", px(radius)},
                       {"fill", std::string(fill)}});
  };
  band(top, top + height, palette::kGround, 6);
  if (info.reach_y_m && info.reach_y_m->first <= info.reach_y_m->second) {
    const auto limit = [&](double y_m) {
      return layout.y_px(strip, std::clamp(y_m, layout.y_low_m, layout.y_high_m));
    };
    band(top, limit(info.reach_y_m->second), "#e9e7de", 6);
    band(limit(info.reach_y_m->first), top + height, "#e9e7de", 6);
  }
  for (const double y_m : ledger.row_y_m) {
    if (!(y_m >= layout.y_low_m && y_m <= layout.y_high_m)) continue;
    draw_line(svg, left, layout.y_px(strip, y_m), right, layout.y_px(strip, y_m), "#bcd6c3", 1.2,
              "7 5");
  }
  const double tick_m = ticks(0.0, layout.strip_m, 10).at(1);
  const auto first_tick = static_cast<int>(std::ceil(from_m / tick_m - 1e-9));
  const auto last_tick = static_cast<int>(std::floor(to_m / tick_m + 1e-9));
  for (int tick = first_tick; tick <= last_tick; ++tick) {
    const double x = layout.x_px(strip, tick * tick_m);
    draw_line(svg, x, top + height, x, top + height + 4, palette::kMuted);
    if (tick % 2 != 0 && layout.strip_m / tick_m > 6) continue;
    draw_text(svg, x, top + height + 16, number(tick * tick_m, 3) + " m", "middle", palette::kMuted,
              10);
  }
  for (const double y_m : {-0.5, 0.0, 0.5}) {
    if (y_m < layout.y_low_m || y_m > layout.y_high_m) continue;
    draw_line(svg, left - 4, layout.y_px(strip, y_m), left, layout.y_px(strip, y_m),
              palette::kMuted);
    draw_text(svg, left - 7, layout.y_px(strip, y_m) + 3.5, number(y_m, 1), "end", palette::kMuted,
              10);
  }
}

/// Both ends of a segment decide in which strips it is drawn; the strip's clip cuts it.
void draw_routes(Markup& svg, const Layout& layout, int strip,
                 const std::vector<RouteView>& routes) {
  for (const RouteView& route : routes) {
    std::string path;
    bool pen_down = false;
    for (std::size_t i = 0; i + 1 < route.p_F_m.size(); ++i) {
      const Eigen::Vector2d& a = route.p_F_m[i];
      const Eigen::Vector2d& b = route.p_F_m[i + 1];
      const auto [first, last] = layout.strips_of(std::min(a.x(), b.x()), std::max(a.x(), b.x()));
      if (strip < first || strip > last) {
        pen_down = false;
        continue;
      }
      const auto point = [&](const Eigen::Vector2d& p) {
        return number(layout.x_px(strip, p.x()), 1) + " " + number(layout.y_px(strip, p.y()), 1);
      };
      if (!pen_down) path += "M" + point(a);
      path += "L" + point(b);
      pen_down = true;
    }
    if (path.empty()) continue;
    svg.empty("path", {{"d", path},
                       {"fill", "none"},
                       {"stroke", std::string(axis_color(static_cast<std::size_t>(route.axis)))},
                       {"stroke-width", "1.3"},
                       {"stroke-opacity", "0.75"},
                       {"stroke-linejoin", "round"}});
  }
}

void draw_spray(Markup& svg, const Layout& layout, int strip, const Spray& spray) {
  const std::string color(axis_color(static_cast<std::size_t>(spray.axis)));
  const double r = spray.radius_m * layout.px_per_m;
  const Eigen::Vector2d half = spray.sweep_F_m / 2;
  const double x = layout.x_px(strip, spray.p_F_m.x());
  const double y = layout.y_px(strip, spray.p_F_m.y());
  if (is_place(half) && half.norm() * layout.px_per_m > 0.5) {
    svg.empty("line", {{"x1", px(x - half.x() * layout.px_per_m)},
                       {"y1", px(y + half.y() * layout.px_per_m)},
                       {"x2", px(x + half.x() * layout.px_per_m)},
                       {"y2", px(y - half.y() * layout.px_per_m)},
                       {"stroke", color},
                       {"stroke-width", px(2 * r)},
                       {"stroke-linecap", "round"},
                       {"stroke-opacity", "0.14"}});
  }
  svg.empty("circle", {{"cx", px(x)},
                       {"cy", px(y)},
                       {"r", px(r)},
                       {"fill", color},
                       {"fill-opacity", "0.2"},
                       {"stroke", color},
                       {"stroke-width", "1"}});
}

void draw_header(Markup& svg, const Layout& layout, const Summary& summary) {
  draw_text(svg, 0, 18, summary.field.empty() ? "field" : summary.field, "start", palette::kInk, 17,
            "650");
  std::string line = summary.source;
  if (summary.simulated) line = "simulated run" + (line.empty() ? "" : " \xC2\xB7 " + line);
  if (summary.interrupted) line += (line.empty() ? "" : " \xC2\xB7 ") + std::string("interrupted");
  if (!summary.against_truth) line += " \xC2\xB7 computed from the robot's own tracks";
  draw_text(svg, 0, 36, line, "start", palette::kMuted);
  const double right = kWidth_px - 12;
  draw_text(svg, right - 58, 18, "direction of travel", "end", palette::kMuted);
  svg.empty("path", {{"d", "M" + px(right - 50) + " 14H" + px(right - 8) + "M" + px(right - 14) +
                               " 9L" + px(right - 6) + " 14L" + px(right - 14) + " 19"},
                     {"fill", "none"},
                     {"stroke", std::string(palette::kInk)},
                     {"stroke-width", "1.8"},
                     {"stroke-linecap", "round"},
                     {"stroke-linejoin", "round"}});
  const double bar_m = ticks(0.0, layout.strip_m, 10).at(1);
  const double bar_px = bar_m * layout.px_per_m;
  draw_line(svg, right - 6 - bar_px, 38, right - 6, 38, palette::kInk, 2);
  draw_line(svg, right - 6 - bar_px, 34, right - 6 - bar_px, 42, palette::kInk, 1.4);
  draw_line(svg, right - 6, 34, right - 6, 42, palette::kInk, 1.4);
  draw_text(svg, right - 14 - bar_px, 42, number(bar_m, 3) + " m", "end", palette::kMuted);
}

template <class T, class Extent>
std::vector<std::vector<const T*>> by_strip(const std::vector<T>& items, const Layout& layout,
                                            Extent extent) {
  std::vector<std::vector<const T*>> result(static_cast<std::size_t>(layout.strips));
  for (const T& item : items) {
    const double r = extent(item);
    if (!is_place(item.p_F_m) || !std::isfinite(r)) continue;
    const auto [first, last] = layout.strips_of(item.p_F_m.x() - r, item.p_F_m.x() + r);
    for (int s = first; s <= last; ++s) result[static_cast<std::size_t>(s)].push_back(&item);
  }
  return result;
}

}  // namespace

std::string map_svg_part(const Ledger& ledger, const RunRecord& record, double max_length_m) {
  Layout layout = make_map_layout(ledger, max_length_m);
  Markup legend;
  // Glyphs are up to 4 px wider than their column.
  const double legend_px = draw_map_legend(legend, ledger.summary, 4, 56, kWidth_px - 4);
  layout.top_px = 56 + legend_px + 8;
  const double height_px = layout.strip_top_px(layout.strips) - Layout::kGap_px + 26;

  std::vector<RouteView> routes;
  for (const RouteView& route : record.routes) {
    if (route.axis < 0) continue;
    routes.push_back({route.axis, simplified(route.p_F_m, 0.5 / layout.px_per_m)});
  }
  // A little more than the true size: what is small is drawn larger.
  const auto plants = by_strip(ledger.rows, layout, [&](const LedgerRow& row) {
    return std::max(row.radius_m, 10.0 / layout.px_per_m);
  });
  const auto sprays = by_strip(record.sprays, layout, [](const Spray& spray) {
    return spray.radius_m + spray.sweep_F_m.norm();
  });

  Markup svg;
  open_chart(svg, kWidth_px, height_px, "");
  svg.element("title", "Map of " + ledger.summary.field);
  draw_glyph_definitions(svg);
  svg.open("defs");
  for (int s = 0; s < layout.strips; ++s) {
    const double to_m = std::min((s + 1) * layout.strip_m, layout.to_m);
    svg.open("clipPath", {{"id", "furrow-strip-" + std::to_string(s)}});
    svg.empty("rect", {{"x", px(Layout::kMargin_px)},
                       {"y", px(layout.strip_top_px(s))},
                       {"width", px(layout.x_px(s, to_m) - Layout::kMargin_px)},
                       {"height", px(layout.strip_height_px())},
                       {"rx", "6"}});
    svg.close();
  }
  svg.close();
  svg.empty("rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "#ffffff"}});
  draw_header(svg, layout, ledger.summary);
  svg.raw(legend.finish());
  for (int s = 0; s < layout.strips; ++s) {
    const auto index = static_cast<std::size_t>(s);
    draw_strip_ground(svg, layout, s, ledger, record.info);
    svg.open("g", {{"clip-path", "url(#furrow-strip-" + std::to_string(s) + ")"}});
    for (const bool crops : {true, false}) {
      for (const LedgerRow* row : plants[index]) {
        if ((row->kind == field::PlantKind::kCrop) != crops) continue;
        draw_plant(svg, *row, layout.x_px(s, row->p_F_m.x()), layout.y_px(s, row->p_F_m.y()),
                   row->radius_m * layout.px_per_m);
      }
      // Routes and sprays lie over the crops and under the weeds.
      if (!crops) continue;
      draw_routes(svg, layout, s, routes);
      for (const Spray* spray : sprays[index]) draw_spray(svg, layout, s, *spray);
    }
    svg.close();
  }
  return svg.finish();
}

std::string map_svg(const Ledger& ledger, const RunRecord& record) {
  return map_svg_part(ledger, record, std::numeric_limits<double>::infinity());
}

}  // namespace furrow::ledger
