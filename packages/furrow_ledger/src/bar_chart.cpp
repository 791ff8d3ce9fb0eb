#include <algorithm>
#include <cmath>

#include "chart_frame.hpp"
#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/palette.hpp"

namespace furrow::ledger {

std::string to_svg(const BarChart& chart) {
  constexpr double kTop_px = 34.0;
  constexpr double kPitch_px = 26.0;
  constexpr double kBar_px = 15.0;
  std::vector<Bar> bars;
  for (const Bar& bar : chart.bars) {
    if (std::isfinite(bar.value)) bars.push_back(bar);
  }
  if (bars.empty()) return no_data(chart.width_px, chart.title);

  double label_px = 0.0;
  double greatest = 0.0;
  double value_px = 0.0;
  const auto value_text = [&chart](double value) {
    return number(value, chart.decimals) + (chart.unit.empty() ? "" : " " + chart.unit);
  };
  for (const Bar& bar : bars) {
    label_px = std::max(label_px, text_width_px(bar.label));
    value_px = std::max(value_px, text_width_px(value_text(bar.value)));
    greatest = std::max(greatest, bar.value);
  }
  label_px = std::min(label_px, chart.width_px * 0.45);
  const double left = label_px + 12;
  const double room = std::max(chart.width_px - left - value_px - 14, 20.0);

  Markup svg;
  open_chart(svg, chart.width_px, kTop_px + kPitch_px * static_cast<double>(bars.size()) + 4,
             chart.title);
  double y = kTop_px;
  for (const Bar& bar : bars) {
    const double length = greatest > 0.0 ? std::max(bar.value, 0.0) / greatest * room : 0.0;
    svg.open("g");
    if (!bar.note.empty()) svg.element("title", bar.note);
    draw_text(svg, label_px, y + 12, bar.label, "end", palette::kInk);
    svg.empty("rect", {{"x", px(left)},
                       {"y", px(y)},
                       {"width", px(room)},
                       {"height", px(kBar_px)},
                       {"rx", "3"},
                       {"fill", "#f0f2ee"}});
    svg.empty("rect", {{"x", px(left)},
                       {"y", px(y)},
                       {"width", px(length)},
                       {"height", px(kBar_px)},
                       {"rx", "3"},
                       {"fill", color_or(bar.color, 0)}});
    draw_text(svg, left + room + 10, y + 12, value_text(bar.value), "start", palette::kInk, 12,
              "600");
    svg.close();
    y += kPitch_px;
  }
  return svg.finish();
}

std::string to_svg(const GroupedBarChart& chart) {
  double low = 0.0;
  double high = 0.0;
  bool any = false;
  for (const auto& series : chart.series) {
    for (const auto& sample : series.samples) {
      if (!sample || !std::isfinite(sample->value)) continue;
      any = true;
      low = std::min({low, sample->value, sample->low.value_or(0.0)});
      high = std::max({high, sample->value, sample->high.value_or(0.0)});
    }
  }
  if (!any || chart.categories.empty()) return no_data(chart.width_px, chart.title);

  Markup svg;
  open_chart(svg, chart.width_px, chart.height_px, chart.title);
  std::vector<LegendEntry> legend;
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    legend.push_back({chart.series[s].name, color_or(chart.series[s].color, s)});
  }
  const double legend_px = draw_legend(svg, 0, 26, chart.width_px, legend);
  const Area area{52, chart.width_px - 6, 26 + legend_px + 26, chart.height_px - 30};
  Scale y = make_scale(low, high, false, 5);
  y.from_px = area.bottom;
  y.to_px = area.top;
  draw_y_axis(svg, area, y, chart.y_label);

  const double group_px = (area.right - area.left) / static_cast<double>(chart.categories.size());
  const double bar_px = std::min(group_px * 0.76 / static_cast<double>(chart.series.size()), 46.0);
  for (std::size_t c = 0; c < chart.categories.size(); ++c) {
    const double middle = area.left + group_px * (static_cast<double>(c) + 0.5);
    draw_text(svg, middle, area.bottom + 18, chart.categories[c], "middle", palette::kInk, 11);
    double x = middle - bar_px * static_cast<double>(chart.series.size()) / 2;
    for (std::size_t s = 0; s < chart.series.size(); ++s, x += bar_px) {
      const auto& samples = chart.series[s].samples;
      if (c >= samples.size() || !samples[c] || !std::isfinite(samples[c]->value)) continue;
      const double at = y.px(samples[c]->value);
      const double zero = y.px(0.0);
      svg.open("rect", {{"x", px(x + 1)},
                        {"y", px(std::min(at, zero))},
                        {"width", px(bar_px - 2)},
                        {"height", px(std::max(std::abs(zero - at), 0.6))},
                        {"rx", "2"},
                        {"fill", legend[s].color}});
      svg.element("title", chart.series[s].name + ", " + chart.categories[c] + ": " +
                               number(samples[c]->value, 3));
      svg.close();
      if (samples[c]->low && samples[c]->high) {
        draw_error_bar(svg, x + bar_px / 2, y.px(*samples[c]->low), y.px(*samples[c]->high),
                       palette::kInk);
      }
    }
  }
  draw_line(svg, area.left, y.px(0.0), area.right, y.px(0.0), palette::kMuted);
  return svg.finish();
}

}  // namespace furrow::ledger
