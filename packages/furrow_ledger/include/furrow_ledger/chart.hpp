#pragma once

#include <optional>
#include <string>
#include <vector>

namespace furrow::ledger {

// Charts as self-contained <svg> elements, to be put into a page or written to a file. Values that
// are not finite are left out. Sizes are in px. An empty chart says "no data".

struct Bar {
  std::string label;
  double value = 0.0;
  std::string color;  ///< empty: the first series colour
  std::string note;   ///< shown when hovered; may be empty
};
/// Horizontal bars from zero, the value written behind each.
struct BarChart {
  std::string title;
  std::string unit;  ///< behind each value, "%"; may be empty
  std::vector<Bar> bars;
  int decimals = 1;
  double width_px = 520.0;
};
[[nodiscard]] std::string to_svg(const BarChart& chart);

struct Sample {
  double value = 0.0;
  std::optional<double> low = {};  ///< error bar, absolute
  std::optional<double> high = {};
};
/// Upright bars in groups: a group for each category, in it a bar for each series.
struct GroupedBarChart {
  struct Series {
    std::string name;
    std::string color;                           ///< empty: by its place
    std::vector<std::optional<Sample>> samples;  ///< one for each category
  };
  std::string title;
  std::string y_label;
  std::vector<std::string> categories;
  std::vector<Series> series;
  double width_px = 720.0;
  double height_px = 320.0;
};
[[nodiscard]] std::string to_svg(const GroupedBarChart& chart);

/// Lines with markers and error bars over a linear or logarithmic x.
struct LineChart {
  struct Point {
    double x = 0.0;
    Sample y;
  };
  struct Series {
    std::string name;
    std::string color;  ///< empty: by its place
    std::vector<Point> points;
    bool dashed = false;  ///< for figures of others, beside ours
  };
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<Series> series;
  bool log_x = false;
  bool log_y = false;
  bool y_from_zero = true;
  double width_px = 720.0;
  double height_px = 340.0;
};
[[nodiscard]] std::string to_svg(const LineChart& chart);

/// How often values fall into bins of equal width, with marked limits.
struct Histogram {
  struct Mark {
    double x = 0.0;
    std::string label;
  };
  std::string title;
  std::string x_label;
  std::string y_label;
  std::vector<double> values;
  double bin_width = 1.0;
  double x_max = 0.0;  ///< 0: as the values need; above it values go into the last bin
  std::vector<Mark> marks;
  std::string color;
  double width_px = 520.0;
  double height_px = 260.0;
};
[[nodiscard]] std::string to_svg(const Histogram& chart);

/// Round tick values that span [low, high], about `count` of them.
[[nodiscard]] std::vector<double> ticks(double low, double high, int count);

}  // namespace furrow::ledger
