#include <algorithm>
#include <cmath>

#include "chart_frame.hpp"
#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/palette.hpp"

namespace furrow::ledger {

std::string to_svg(const Histogram& chart) {
  constexpr double kMostBins = 400.0;
  double greatest = chart.x_max;
  std::vector<double> values;
  for (const double value : chart.values) {
    if (!std::isfinite(value) || value < 0.0) continue;
    values.push_back(value);
    if (chart.x_max <= 0.0) greatest = std::max(greatest, value);
  }
  if (values.empty() || !(chart.bin_width > 0.0)) return no_data(chart.width_px, chart.title);
  const double needed = chart.x_max > 0.0 ? std::ceil(greatest / chart.bin_width - 1e-9)
                                          : std::floor(greatest / chart.bin_width) + 1.0;
  const double bins = std::clamp(needed, 1.0, kMostBins);
  std::vector<std::int64_t> counts(static_cast<std::size_t>(bins), 0);
  for (const double value : values) {
    ++counts[static_cast<std::size_t>(std::min(std::floor(value / chart.bin_width), bins - 1))];
  }

  Markup svg;
  open_chart(svg, chart.width_px, chart.height_px, chart.title);
  const Area area{44, chart.width_px - 10, 52, chart.height_px - 42};
  Scale y = make_scale(0.0, static_cast<double>(*std::max_element(counts.begin(), counts.end())),
                       false, 4);
  y.from_px = area.bottom;
  y.to_px = area.top;
  const Scale x{
      .low = 0.0, .high = bins * chart.bin_width, .from_px = area.left, .to_px = area.right};
  draw_y_axis(svg, area, y, chart.y_label);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const double from = static_cast<double>(i) * chart.bin_width;
    const double top = y.px(static_cast<double>(counts[i]));
    svg.open("rect", {{"x", px(x.px(from) + 0.75)},
                      {"y", px(top)},
                      {"width", px(std::max(x.px(from + chart.bin_width) - x.px(from) - 1.5, 0.5))},
                      {"height", px(area.bottom - top)},
                      {"rx", "1.5"},
                      {"fill", color_or(chart.color, 0)}});
    const bool open_ended = chart.x_max > 0.0 && i + 1 == counts.size();
    svg.element("title", number(from) +
                             (open_ended ? " and more" : " to " + number(from + chart.bin_width)) +
                             ": " + std::to_string(counts[i]));
    svg.close();
  }
  draw_x_axis(svg, area, x, chart.x_label);
  for (const Histogram::Mark& mark : chart.marks) {
    if (!(mark.x >= x.low && mark.x <= x.high)) continue;
    draw_line(svg, x.px(mark.x), area.top - 6, x.px(mark.x), area.bottom, palette::kInk, 1.2,
              "4 3");
    const bool near_end = x.px(mark.x) + text_width_px(mark.label, 11) + 6 > area.right;
    draw_text(svg, x.px(mark.x) + (near_end ? -5 : 5), area.top + 4, mark.label,
              near_end ? "end" : "start", palette::kInk, 11);
  }
  return svg.finish();
}

}  // namespace furrow::ledger
