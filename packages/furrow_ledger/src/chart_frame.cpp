#include "chart_frame.hpp"

#include <algorithm>
#include <cmath>

#include "furrow_ledger/palette.hpp"

namespace furrow::ledger {
namespace {

constexpr std::string_view kFont =
    "Inter, system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif";

/// 1, 2, 2.5 or 5 times a power of ten, not below `raw`.
double round_step(double raw) {
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (raw <= factor * power * (1.0 + 1e-9)) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace

std::vector<double> ticks(double low, double high, int count) {
  if (!std::isfinite(low) || !std::isfinite(high) || count < 1) return {};
  if (low > high) std::swap(low, high);
  double span = high / 2 - low / 2;  // half, which cannot overflow
  if (span <= std::max(std::abs(low), std::abs(high)) * 1e-12) {
    const double half = std::max(std::abs(low) / 2, 0.5);
    low -= half;
    high += half;
    span = half;
  }
  const double step = round_step(span / count * 2);
  if (!std::isfinite(step) || !(step > 0.0)) return {};
  const double first = std::floor(low / step + 1e-9);
  const double last = std::ceil(high / step - 1e-9);
  const int steps = static_cast<int>(std::min(last - first, 1000.0));
  std::vector<double> values;
  for (int i = 0; i <= steps; ++i) values.push_back((first + i) * step);
  return values;
}

double Scale::px(double value) const {
  const double t =
      log ? (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low))
          : (value - low) / (high - low);
  return from_px + t * (to_px - from_px);
}

std::vector<double> Scale::tick_values(int count) const {
  if (!log) return ticks(low, high, count);
  std::vector<double> values;
  const bool wide = high / low > 1e3;
  const int last = static_cast<int>(std::floor(std::log10(high)));
  for (int power = static_cast<int>(std::floor(std::log10(low))); power <= last; ++power) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      const double value = factor * std::pow(10.0, power);
      if (wide && factor != 1.0) continue;
      if (value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9)) values.push_back(value);
    }
  }
  return values;
}

Scale make_scale(double low, double high, bool log, int tick_count) {
  if (log) {
    if (high / low < 2.0) return {.low = low / 2, .high = high * 2, .log = true};
    return {.low = low / 1.15, .high = high * 1.15, .log = true};
  }
  const std::vector<double> values = ticks(low, high, tick_count);
  if (values.size() < 2) return {.low = low, .high = low + 1.0};
  return {.low = values.front(), .high = values.back()};
}

std::string px(double value) {
  return number(value, 2);
}

double text_width_px(std::string_view text, double font_px) {
  const auto characters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U;
  });
  return 0.58 * font_px * static_cast<double>(characters);
}

std::string tick_text(double value) {
  const double magnitude = std::abs(value);
  if (magnitude >= 1e6 || (magnitude > 0.0 && magnitude < 1e-4)) {
    const double power = std::floor(std::log10(magnitude));
    return number(value / std::pow(10.0, power), 2) + "e" + number(power, 0);
  }
  return number(value, 6);
}

void draw_text(Markup& svg, double x, double y, std::string_view text, std::string_view anchor,
               std::string_view color, double font_px, std::string_view weight) {
  svg.element("text", text,
              {{"x", px(x)},
               {"y", px(y)},
               {"text-anchor", std::string(anchor)},
               {"fill", std::string(color)},
               {"font-size", px(font_px)},
               {"font-weight", std::string(weight)}});
}

void draw_line(Markup& svg, double x1, double y1, double x2, double y2, std::string_view color,
               double width_px, std::string_view dashes) {
  svg.empty("line", {{"x1", px(x1)},
                     {"y1", px(y1)},
                     {"x2", px(x2)},
                     {"y2", px(y2)},
                     {"stroke", std::string(color)},
                     {"stroke-width", px(width_px)},
                     {"stroke-dasharray", dashes.empty() ? "none" : std::string(dashes)}});
}

void open_chart(Markup& svg, double width_px, double height_px, std::string_view title) {
  svg.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                   {"viewBox", "0 0 " + px(width_px) + " " + px(height_px)},
                   {"width", px(width_px)},
                   {"height", px(height_px)},
                   {"role", "img"},
                   {"aria-label", std::string(title)},
                   {"font-family", std::string(kFont)},
                   {"font-size", "12"}});
  if (!title.empty()) draw_text(svg, 0, 16, title, "start", palette::kInk, 14, "600");
}

std::string no_data(double width_px, std::string_view title) {
  Markup svg;
  open_chart(svg, width_px, 72, title);
  draw_text(svg, 0, 48, "no data", "start", palette::kMuted);
  return svg.finish();
}

void draw_y_axis(Markup& svg, const Area& area, const Scale& y, std::string_view label) {
  for (const double value : y.tick_values(5)) {
    const double at = y.px(value);
    if (at < area.top - 0.5 || at > area.bottom + 0.5) continue;
    draw_line(svg, area.left, at, area.right, at, palette::kFaint);
    draw_text(svg, area.left - 8, at + 4, tick_text(value), "end", palette::kMuted, 11);
  }
  if (!label.empty()) {
    draw_text(svg, 0, area.top - 12, label, "start", palette::kMuted, 11);
  }
}

void draw_x_axis(Markup& svg, const Area& area, const Scale& x, std::string_view label) {
  draw_line(svg, area.left, area.bottom, area.right, area.bottom, palette::kMuted);
  for (const double value : x.tick_values(8)) {
    const double at = x.px(value);
    if (at < area.left - 0.5 || at > area.right + 0.5) continue;
    draw_line(svg, at, area.bottom, at, area.bottom + 4, palette::kMuted);
    draw_text(svg, at, area.bottom + 18, tick_text(value), "middle", palette::kMuted, 11);
  }
  draw_x_label(svg, area, label, 36);
}

void draw_x_label(Markup& svg, const Area& area, std::string_view label, double below_px) {
  if (label.empty()) return;
  draw_text(svg, (area.left + area.right) / 2, area.bottom + below_px, label, "middle",
            palette::kMuted, 11);
}

double draw_legend(Markup& svg, double left_px, double top_px, double width_px,
                   const std::vector<LegendEntry>& entries) {
  constexpr double kLine_px = 18.0;
  double x = left_px;
  double y = top_px;
  for (const LegendEntry& entry : entries) {
    const double needed = 26 + text_width_px(entry.name) + 18;
    if (x > left_px && x + needed > left_px + width_px) {
      x = left_px;
      y += kLine_px;
    }
    draw_line(svg, x, y + 8, x + 18, y + 8, entry.color, 3.5, entry.dashed ? "5 3" : "");
    draw_text(svg, x + 24, y + 12, entry.name, "start", palette::kInk);
    x += needed;
  }
  return entries.empty() ? 0.0 : y - top_px + kLine_px;
}

void draw_error_bar(Markup& svg, double x_px, double low_px, double high_px,
                    std::string_view color) {
  draw_line(svg, x_px, low_px, x_px, high_px, color, 1.4);
  draw_line(svg, x_px - 4, low_px, x_px + 4, low_px, color, 1.4);
  draw_line(svg, x_px - 4, high_px, x_px + 4, high_px, color, 1.4);
}

std::string color_or(const std::string& color, std::size_t index) {
  return color.empty() ? std::string(series_color(index)) : color;
}

}  // namespace furrow::ledger
