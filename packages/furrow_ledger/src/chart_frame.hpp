#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "furrow_ledger/chart.hpp"
#include "furrow_ledger/markup.hpp"

namespace furrow::ledger {

/// Maps values to px, linear or by logarithm.
struct Scale {
  double low = 0.0;
  double high = 1.0;
  double from_px = 0.0;
  double to_px = 1.0;
  bool log = false;

  [[nodiscard]] double px(double value) const;
  [[nodiscard]] std::vector<double> tick_values(int count) const;
};

/// A linear scale widened to round ticks; a logarithmic one to the data.
[[nodiscard]] Scale make_scale(double low, double high, bool log, int tick_count);

/// The plot area inside a chart.
struct Area {
  double left;
  double right;
  double top;
  double bottom;
};

struct LegendEntry {
  std::string name;
  std::string color;
  bool dashed = false;
};

[[nodiscard]] std::string px(double value);
/// About as wide as text of this size is drawn.
[[nodiscard]] double text_width_px(std::string_view text, double font_px = 12.0);
[[nodiscard]] std::string tick_text(double value);

/// Opens <svg> and writes the title; finish() of the markup closes it.
void open_chart(Markup& svg, double width_px, double height_px, std::string_view title);
[[nodiscard]] std::string no_data(double width_px, std::string_view title);
/// Lines across the area and numbers to its left.
void draw_y_axis(Markup& svg, const Area& area, const Scale& y, std::string_view label);
/// The base line with ticks and numbers below.
void draw_x_axis(Markup& svg, const Area& area, const Scale& x, std::string_view label);
void draw_x_label(Markup& svg, const Area& area, std::string_view label, double below_px);
/// In one line above the area, wrapped when it does not fit. Returns the height it needs.
double draw_legend(Markup& svg, double left_px, double top_px, double width_px,
                   const std::vector<LegendEntry>& entries);
void draw_error_bar(Markup& svg, double x_px, double low_px, double high_px,
                    std::string_view color);
void draw_line(Markup& svg, double x1, double y1, double x2, double y2, std::string_view color,
               double width_px = 1.0, std::string_view dashes = "");
void draw_text(Markup& svg, double x, double y, std::string_view text, std::string_view anchor,
               std::string_view color, double font_px = 12.0, std::string_view weight = "400");

/// `color`, or the i-th series colour when it is empty.
[[nodiscard]] std::string color_or(const std::string& color, std::size_t index);

}  // namespace furrow::ledger
