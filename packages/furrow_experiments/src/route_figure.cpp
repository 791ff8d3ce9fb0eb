#include "furrow_experiments/route_figure.hpp"

#include <algorithm>

#include "furrow_ledger/markup.hpp"
#include "furrow_ledger/palette.hpp"

namespace furrow::experiments {
namespace {

using ledger::Markup;
using ledger::number;
namespace palette = ledger::palette;

constexpr double kPxPerM = 230.0;
constexpr double kTitle_px = 46.0;
constexpr double kScale_px = 26.0;
constexpr double kMargin_m = 0.03;  ///< of ground around the span

std::string px(double value) {
  return number(value, 1);
}

/// Draws in px from the upper left corner of the ground.
class Ground {
 public:
  Ground(const RouteExample& example, Markup& svg) : example_(example), svg_(svg) {}

  [[nodiscard]] double width_px() const { return kPxPerM * (example_.to_x_m - example_.from_x_m); }
  [[nodiscard]] double height_px() const {
    return kPxPerM * (example_.setup.axis_travel_m + 2.0 * kMargin_m);
  }

  void draw() {
    svg_.empty("rect", {{"width", px(width_px())},
                        {"height", px(height_px())},
                        {"fill", std::string(palette::kGround)}});
    for (const auto& crop : example_.field.crops) {
      if (shown(crop.p_F)) disc(crop.p_F, 7.0, palette::kCrop);
    }
    footprints();
    routes();
    weeds();
  }

  /// Of the weeds on the stretch.
  [[nodiscard]] std::string tally() const {
    int all = 0;
    int missed = 0;
    for (std::size_t i = 0; i < example_.field.weeds.size(); ++i) {
      if (!shown(example_.field.weeds[i].p_F)) continue;
      ++all;
      missed += treated(i) ? 0 : 1;
    }
    return std::to_string(missed) + " of " + std::to_string(all) + " weeds missed here";
  }

 private:
  [[nodiscard]] bool shown(const Eigen::Vector2d& p_F) const {
    return p_F.x() >= example_.from_x_m && p_F.x() <= example_.to_x_m;
  }
  [[nodiscard]] bool treated(std::size_t weed) const {
    return example_.drive.outcomes[weed].decision == planning::Decision::kTreat;
  }
  [[nodiscard]] std::string x(double x_m) const { return px(kPxPerM * (x_m - example_.from_x_m)); }
  [[nodiscard]] std::string y(double y_m) const { return px(0.5 * height_px() - kPxPerM * y_m); }

  void disc(const Eigen::Vector2d& p_F, double radius_px, std::string_view color) {
    svg_.empty("circle", {{"cx", x(p_F.x())},
                          {"cy", y(p_F.y())},
                          {"r", px(radius_px)},
                          {"fill", std::string(color)}});
  }

  void footprints() {
    for (const Spray& spray : example_.drive.sprays) {
      if (!shown(spray.aim_F)) continue;
      svg_.empty("circle", {{"cx", x(spray.aim_F.x())},
                            {"cy", y(spray.aim_F.y())},
                            {"r", px(kPxPerM * example_.footprint_radius_m)},
                            {"fill", std::string(ledger::axis_color(spray.axis))},
                            {"fill-opacity", "0.22"}});
    }
  }

  void routes() {
    const auto& sprays = example_.drive.sprays;
    for (std::size_t axis = 0; axis < static_cast<std::size_t>(example_.setup.axes); ++axis) {
      std::string points;
      for (const Spray& spray : sprays) {
        // One more at either end, so that the way runs on over the edge.
        const double slack_m = 1.0;
        if (spray.axis != axis || spray.aim_F.x() < example_.from_x_m - slack_m ||
            spray.aim_F.x() > example_.to_x_m + slack_m) {
          continue;
        }
        points += x(spray.aim_F.x()) + "," + y(spray.aim_F.y()) + " ";
      }
      svg_.empty("polyline", {{"points", points},
                              {"fill", "none"},
                              {"stroke", std::string(ledger::axis_color(axis))},
                              {"stroke-width", "1.8"},
                              {"stroke-linejoin", "round"}});
    }
  }

  void weeds() {
    for (std::size_t i = 0; i < example_.field.weeds.size(); ++i) {
      const Eigen::Vector2d& p_F = example_.field.weeds[i].p_F;
      if (!shown(p_F)) continue;
      if (treated(i)) {
        disc(p_F, 2.6, palette::kInk);
        continue;
      }
      svg_.empty("circle", {{"cx", x(p_F.x())},
                            {"cy", y(p_F.y())},
                            {"r", "5.5"},
                            {"fill", "#ffffff"},
                            {"stroke", std::string(palette::kMissed)},
                            {"stroke-width", "3"}});
    }
  }

  const RouteExample& example_;
  Markup& svg_;
};

void draw_scale(Markup& svg, const RouteExample& example, double top_px) {
  constexpr double kTick_m = 0.5;
  const double length_m = example.to_x_m - example.from_x_m;
  for (int i = 0; kTick_m * i <= length_m + 1e-9; ++i) {
    const double at_m = kTick_m * i;
    const char* anchor = i == 0 ? "start" : (at_m > length_m - 0.1 ? "end" : "middle");
    svg.element("text", number(at_m, 1) + (i == 0 ? " m" : ""),
                {{"x", px(kPxPerM * at_m)},
                 {"y", px(top_px + 18.0)},
                 {"font-size", "13"},
                 {"text-anchor", anchor},
                 {"fill", std::string(palette::kMuted)}});
  }
}

}  // namespace

std::string to_svg(const RouteExample& example) {
  Markup svg;
  Ground ground(example, svg);
  const double width_px = ground.width_px();
  const double height_px = kTitle_px + ground.height_px() + kScale_px;
  svg.open("svg", {{"xmlns", "http://www.w3.org/2000/svg"},
                   {"viewBox", "0 0 " + px(width_px) + " " + px(height_px)},
                   {"width", px(width_px)},
                   {"font-family", "Inter, system-ui, sans-serif"},
                   {"role", "img"}});
  svg.element("title", example.title);
  svg.element("text", example.title,
              {{"x", "0"},
               {"y", "16"},
               {"font-size", "16"},
               {"font-weight", "600"},
               {"fill", std::string(palette::kInk)}});
  svg.element(
      "text", ground.tally(),
      {{"x", "0"}, {"y", "36"}, {"font-size", "14"}, {"fill", std::string(palette::kMuted)}});
  // An inner <svg> cuts what runs over its edge.
  svg.open("svg",
           {{"y", px(kTitle_px)}, {"width", px(width_px)}, {"height", px(ground.height_px())}});
  ground.draw();
  svg.close();
  draw_scale(svg, example, kTitle_px + ground.height_px());
  return svg.finish();
}

}  // namespace furrow::experiments
