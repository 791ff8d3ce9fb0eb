#include <algorithm>
#include <cmath>
#include <limits>

#include "chart_frame.hpp"
#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/palette.hpp"

namespace furrow::ledger {
namespace {

bool drawable(double value, bool log) {
  return std::isfinite(value) && (!log || value > 0.0);
}

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  void include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// The points that the chart's scales can show, by x.
std::vector<LineChart::Point> shown(const LineChart& chart, const LineChart::Series& series) {
  std::vector<LineChart::Point> points;
  for (LineChart::Point point : series.points) {
    if (!drawable(point.x, chart.log_x) || !drawable(point.y.value, chart.log_y)) continue;
    if (point.y.low && !drawable(*point.y.low, chart.log_y)) point.y.low.reset();
    if (point.y.high && !drawable(*point.y.high, chart.log_y)) point.y.high.reset();
    points.push_back(point);
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.x < b.x; });
  return points;
}

void draw_series(Markup& svg, const LineChart::Series& series,
                 const std::vector<LineChart::Point>& points, const Scale& x, const Scale& y,
                 const std::string& color) {
  std::string path;
  for (const LineChart::Point& point : points) {
    path += px(x.px(point.x)) + "," + px(y.px(point.y.value)) + " ";
  }
  svg.empty("polyline", {{"points", path},
                         {"fill", "none"},
                         {"stroke", color},
                         {"stroke-width", "2"},
                         {"stroke-linejoin", "round"},
                         {"stroke-dasharray", series.dashed ? "6 4" : "none"}});
  for (const LineChart::Point& point : points) {
    if (point.y.low && point.y.high) {
      draw_error_bar(svg, x.px(point.x), y.px(*point.y.low), y.px(*point.y.high), color);
    }
    svg.open("circle", {{"cx", px(x.px(point.x))},
                        {"cy", px(y.px(point.y.value))},
                        {"r", "3.5"},
                        {"fill", series.dashed ? "#ffffff" : color},
                        {"stroke", color},
                        {"stroke-width", "1.5"}});
    svg.element("title", series.name + ": " + number(point.x, 4) + ", " + number(point.y.value, 4));
    svg.close();
  }
}

}  // namespace

std::string to_svg(const LineChart& chart) {
  Range x_range;
  Range y_range;
  std::vector<std::vector<LineChart::Point>> lines;
  for (const LineChart::Series& series : chart.series) {
    lines.push_back(shown(chart, series));
    for (const LineChart::Point& point : lines.back()) {
      x_range.include(point.x);
      y_range.include(point.y.value);
      y_range.include(point.y.low.value_or(point.y.value));
      y_range.include(point.y.high.value_or(point.y.value));
    }
  }
  if (x_range.low > x_range.high) return no_data(chart.width_px, chart.title);
  if (chart.y_from_zero && !chart.log_y) y_range.include(0.0);

  Markup svg;
  open_chart(svg, chart.width_px, chart.height_px, chart.title);
  std::vector<LegendEntry> legend;
  for (std::size_t s = 0; s < chart.series.size(); ++s) {
    legend.push_back(
        {chart.series[s].name, color_or(chart.series[s].color, s), chart.series[s].dashed});
  }
  const double legend_px = draw_legend(svg, 0, 26, chart.width_px, legend);
  const Area area{52, chart.width_px - 14, 26 + legend_px + 26, chart.height_px - 44};
  Scale x = make_scale(x_range.low, x_range.high, chart.log_x, 8);
  x.from_px = area.left;
  x.to_px = area.right;
  Scale y = make_scale(y_range.low, y_range.high, chart.log_y, 5);
  y.from_px = area.bottom;
  y.to_px = area.top;
  draw_y_axis(svg, area, y, chart.y_label);
  draw_x_axis(svg, area, x, chart.x_label);

  for (std::size_t s = 0; s < lines.size(); ++s) {
    draw_series(svg, chart.series[s], lines[s], x, y, legend[s].color);
  }
  return svg.finish();
}

}  // namespace furrow::ledger
