#include "furrow_experiments/sweep.hpp"

#include <utility>

namespace furrow::experiments {
namespace {

struct Knob {
  std::string parameter;
  std::vector<double> values;
  void (*set)(Variant&, double);
};

std::vector<Knob> knobs() {
  return {
      {"speed_mps",
       {0.25, 0.5, 0.75, 1.0, 1.25, 1.5},
       [](Variant& variant, double value) { variant.planner.speed_mps = value; }},
      {"axes",
       {1, 2, 3, 4, 6, 8},
       [](Variant& variant, double value) {
         variant.setup.axes = static_cast<std::int64_t>(value);
       }},
      {"axis_velocity_mps",
       {0.5, 1.0, 2.0, 3.0, 5.0, 8.0},
       [](Variant& variant, double value) { variant.setup.axis_velocity_mps = value; }},
      {"omega",
       {5.0, 10.0, 20.0, 50.0, 100.0},
       [](Variant& variant, double value) { variant.planner.omega = value; }},
  };
}

}  // namespace

Result<std::vector<SweepPoint>> run_sweeps(const FieldCase& field,
                                           const std::vector<PlannerChoice>& planners,
                                           const Variant& base, const SamplingParameters& sampling,
                                           std::size_t threads, const Progress& progress) {
  std::vector<Variant> variants;
  std::vector<SweepPoint> points;
  for (const Knob& knob : knobs()) {
    for (const double value : knob.values) {
      for (const PlannerChoice& choice : planners) {
        Variant variant = base;
        variant.planner.planner = choice.planner;
        variant.planner.assignment = choice.assignment;
        variant.planner.view = "rolling";
        knob.set(variant, value);
        variants.push_back(std::move(variant));
        points.push_back({knob.parameter, value, {}});
      }
    }
  }
  const auto figures = drive_all({field}, variants, sampling, threads, progress);
  if (!figures.ok()) return figures.error();
  for (std::size_t v = 0; v < variants.size(); ++v) {
    points[v].row = summarize(field, variants[v], figures->front()[v]);
  }
  return points;
}

}  // namespace furrow::experiments
