#include "furrow_experiments/observation_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "furrow_experiments/paper_figures.hpp"

namespace furrow::experiments {
namespace {

constexpr double kSweepDensity = 22.3;  ///< where planners differ and none is at its end
constexpr double kExampleLength_m = 3.0;

std::vector<Variant> variants_of(const ObservationExperiment& experiment) {
  std::vector<Variant> variants;
  for (const PlannerChoice& choice : experiment.planners) {
    for (const std::string& view : experiment.views) {
      Variant variant{experiment.planner, experiment.setup, false};
      variant.planner.planner = choice.planner;
      variant.planner.assignment = choice.assignment;
      variant.planner.view = view;
      variants.push_back(std::move(variant));
    }
  }
  return variants;
}

/// The one whose density is nearest to where planners differ most plainly.
const FieldCase& typical(const std::vector<FieldCase>& fields) {
  return *std::min_element(fields.begin(), fields.end(), [](const auto& a, const auto& b) {
    return std::abs(a.weeds_per_m2 - kSweepDensity) < std::abs(b.weeds_per_m2 - kSweepDensity);
  });
}

std::string title_of(const planning::PlannerParameters& planner) {
  return planner.planner + "/" + planner.assignment + ", " + planner.view + " view";
}

Result<std::vector<RouteExample>> drive_examples(const ObservationExperiment& experiment,
                                                 const FieldCase& field,
                                                 const std::vector<Variant>& variants) {
  RowParameters row = experiment.sampling.row;
  row.length_m = std::min(row.length_m, 3.0 * kExampleLength_m);
  auto targets =
      make_targets(field, row, static_cast<std::uint64_t>(experiment.sampling.first_seed));
  if (!targets.ok()) return targets.error();
  const double from_m = std::max(0.0, 0.5 * (targets->length_m - kExampleLength_m));
  std::vector<RouteExample> examples;
  const auto main = main_planner_choices();
  for (const Variant& variant : variants) {
    const PlannerChoice choice{variant.planner.planner, variant.planner.assignment};
    const bool baseline = choice == main.front();
    const bool shown = std::find(main.begin(), main.end(), choice) != main.end();
    if (!shown || (variant.planner.view != "rolling" && !baseline)) continue;
    auto driven = drive(*targets, variant.planner, variant.setup);
    if (!driven.ok()) return driven.error();
    RouteExample example;
    example.title = title_of(variant.planner);
    example.field = *targets;
    example.drive = std::move(*driven);
    example.setup = variant.setup;
    example.footprint_radius_m = variant.planner.footprint_radius_m;
    example.from_x_m = from_m;
    example.to_x_m = std::min(targets->length_m, from_m + kExampleLength_m);
    examples.push_back(std::move(example));
  }
  return examples;
}

/// The paper's planner, and the best with one spray a weed and with footprints.
std::vector<PlannerChoice> sweep_planners(const std::vector<PlannerChoice>& asked) {
  std::vector<PlannerChoice> planners;
  for (const PlannerChoice& choice : main_planner_choices()) {
    const bool greedy = choice.planner == "greedy";
    if (!greedy && std::find(asked.begin(), asked.end(), choice) != asked.end()) {
      planners.push_back(choice);
    }
  }
  return planners;
}

}  // namespace

Result<ObservationResult> run(const ObservationExperiment& experiment, const Progress& progress) {
  const bool sweeps = experiment.sweep_seeds > 0 && !experiment.fields.empty();
  const double table_share = sweeps ? 0.6 : 1.0;
  const std::vector<Variant> variants = variants_of(experiment);
  const auto figures = drive_all(experiment.fields, variants, experiment.sampling,
                                 experiment.threads, [&](double share) {
                                   if (progress) progress(table_share * share);
                                 });
  if (!figures.ok()) return figures.error();

  ObservationResult result;
  for (std::size_t f = 0; f < experiment.fields.size(); ++f) {
    const PaperFigures* paper = paper_figures(experiment.fields[f].name);
    for (std::size_t v = 0; v < variants.size(); ++v) {
      result.rows.push_back(summarize(experiment.fields[f], variants[v], (*figures)[f][v]));
      if (paper == nullptr) continue;
      const bool rolling = variants[v].planner.view == "rolling";
      result.rows.back().paper_loss_pct =
          rolling ? paper->rolling_loss_pct : paper->segment_loss_pct;
    }
  }
  if (experiment.routes && !experiment.fields.empty()) {
    auto examples = drive_examples(experiment, typical(experiment.fields), variants);
    if (!examples.ok()) return examples.error();
    result.routes = std::move(*examples);
  }
  const auto swept = sweep_planners(experiment.planners);
  if (sweeps && !swept.empty()) {
    SamplingParameters sampling = experiment.sampling;
    sampling.seeds = experiment.sweep_seeds;
    const FieldCase& field = typical(experiment.fields);
    auto points = run_sweeps(field, swept, {experiment.planner, experiment.setup, false}, sampling,
                             experiment.threads, [&](double share) {
                               if (progress) progress(table_share + (1.0 - table_share) * share);
                             });
    if (!points.ok()) return points.error();
    result.sweeps = std::move(*points);
    result.sweep_seeds = field.imported ? 1 : experiment.sweep_seeds;
  }
  return result;
}

}  // namespace furrow::experiments
