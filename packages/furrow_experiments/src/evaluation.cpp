#include "furrow_experiments/evaluation.hpp"

#include <algorithm>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>

#include "furrow_core/parallel.hpp"
#include "furrow_core/statistics.hpp"
#include "furrow_experiments/statistics.hpp"
#include "furrow_planning/route_planner.hpp"

namespace furrow::experiments {
namespace {

double lost_pct(std::size_t treated, std::size_t weeds) {
  if (weeds == 0) return 0.0;
  return 100.0 * (1.0 - static_cast<double>(treated) / static_cast<double>(weeds));
}

void weigh(FieldTargets& field, bool by_priority) {
  for (std::size_t i = 0; i < field.weeds.size(); ++i) {
    field.weeds[i].weight = by_priority && !field.high_priority[i] ? kLowWeight : kHighWeight;
  }
}

/// Whether the clairvoyant optimum of both is the same.
bool share_optimum(const Variant& a, const Variant& b) {
  const auto key = [](const Variant& variant) {
    const planning::PlannerParameters& p = variant.planner;
    return std::tuple(p.kinematics, p.rho, p.omega, p.speed_mps, p.dwell_s, p.settle_s,
                      p.footprint_radius_m, p.protection_zone_mm, p.min_weight,
                      variant.by_priority);
  };
  return key(a) == key(b) && a.setup == b.setup;
}

DriveFigures figures_of(const FieldTargets& field, DriveResult&& drive) {
  DriveFigures figures;
  figures.weeds = field.weeds.size();
  figures.sprays = drive.sprays.size();
  figures.travel_m = std::move(drive.travel_m);
  figures.replan_us = std::move(drive.replan_us);
  for (std::size_t i = 0; i < field.weeds.size(); ++i) {
    const planning::Decision decision = drive.outcomes[i].decision;
    const bool treated = decision == planning::Decision::kTreat;
    figures.treated += treated ? 1U : 0U;
    figures.left_for_crop += decision == planning::Decision::kProtectedCrop ? 1U : 0U;
    figures.outside += decision == planning::Decision::kOutside ? 1U : 0U;
    if (field.high_priority[i]) {
      ++figures.high;
      figures.high_treated += treated ? 1U : 0U;
    }
  }
  return figures;
}

/// One field of one seed, and every variant on it.
class Unit {
 public:
  Unit(const std::vector<Variant>& variants, const std::function<void()>& done)
      : variants_(variants), done_(done) {}

  Result<std::vector<DriveFigures>> run(const FieldCase& field, const RowParameters& row,
                                        std::uint64_t seed) {
    auto targets = make_targets(field, row, seed);
    if (!targets.ok()) return targets.error();
    std::vector<DriveFigures> all;
    for (std::size_t v = 0; v < variants_.size(); ++v) {
      const Variant& variant = variants_[v];
      weigh(*targets, variant.by_priority);
      auto driven = drive(*targets, variant.planner, variant.setup);
      if (!driven.ok()) return named(variant, field, seed, driven.error());
      all.push_back(figures_of(*targets, std::move(*driven)));
      const auto optimum = optimum_of(v, *targets, all);
      if (!optimum.ok()) return named(variant, field, seed, optimum.error());
      all.back().optimum_treated = *optimum;
      done_();
    }
    return all;
  }

 private:
  Result<std::size_t> optimum_of(std::size_t v, const FieldTargets& targets,
                                 const std::vector<DriveFigures>& all) const {
    for (std::size_t earlier = 0; earlier < v; ++earlier) {
      if (share_optimum(variants_[earlier], variants_[v])) return all[earlier].optimum_treated;
    }
    return clairvoyant_treated(targets, variants_[v].planner, variants_[v].setup);
  }

  static Error named(const Variant& variant, const FieldCase& field, std::uint64_t seed,
                     const Error& error) {
    return {error.code, variant.planner.planner + "/" + variant.planner.assignment + ", " +
                            variant.planner.view + " view, on " + field.name + ", seed " +
                            std::to_string(seed) + ": " + error.message};
  }

  const std::vector<Variant>& variants_;
  const std::function<void()>& done_;
};

/// Bad parameters show here, before anything is driven.
void check(const std::vector<Variant>& variants, const SamplingParameters& sampling) {
  validate_parameters(sampling);
  for (const Variant& variant : variants) {
    validate_parameters(variant.setup);
    (void)planning::make_observation_view(variant.planner, axis_specs(variant.setup));
  }
}

}  // namespace

void SamplingParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "seeds", .description = "fields of each kind", .min = 1, .max = 1e5}, seeds);
  v.visit({.name = "first_seed", .description = "the others follow it", .min = 0, .max = 1e15},
          first_seed);
  row.visit(v);
}

double DriveFigures::loss_pct() const {
  return lost_pct(treated, weeds);
}

double DriveFigures::optimum_loss_pct() const {
  return lost_pct(optimum_treated, weeds);
}

Result<std::size_t> clairvoyant_treated(const FieldTargets& field,
                                        const planning::PlannerParameters& planner,
                                        const SetupParameters& setup) {
  if (field.weeds.empty()) return std::size_t{0};
  planning::PlannerParameters parameters = planner;
  parameters.planner = "exact";
  parameters.assignment = "joint";
  parameters.max_targets =
      std::max(parameters.max_targets, static_cast<std::int64_t>(field.weeds.size()));
  const auto axes = axis_specs(setup);
  const double start_m = start_x_m(setup);
  // The heads stand as those of an observation view do before the first target.
  std::vector<planning::AxisState> states;
  const double share_m = setup.axis_travel_m / static_cast<double>(setup.axes);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    states.push_back({.position_m = axes[a].lower_m + share_m * (static_cast<double>(a) + 0.5),
                      .free_from_x_m = start_m});
  }
  planning::Plan plan;
  const Status planned = planning::make_route_planner(parameters)
                             ->plan({.targets = field.weeds,
                                     .protected_plants = field.crops,
                                     .axes = axes,
                                     .states = states,
                                     .robot = {.x_m = start_m, .speed_mps = planner.speed_mps}},
                                    plan);
  if (!planned.ok()) return planned.error();
  return plan.treated.size();
}

Result<Figures> drive_all(const std::vector<FieldCase>& fields,
                          const std::vector<Variant>& variants, const SamplingParameters& sampling,
                          std::size_t threads, const Progress& progress) {
  check(variants, sampling);
  const bool priorities = std::any_of(variants.begin(), variants.end(),
                                      [](const Variant& variant) { return variant.by_priority; });
  struct Task {
    std::size_t field = 0;
    std::size_t seed = 0;
    double weeds = 0.0;
  };
  std::vector<Task> tasks;
  Figures figures(fields.size());
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const bool once = fields[f].imported && !priorities;
    const std::size_t seeds = once ? 1 : static_cast<std::size_t>(sampling.seeds);
    figures[f].assign(variants.size(), std::vector<DriveFigures>(seeds));
    for (std::size_t s = 0; s < seeds; ++s) tasks.push_back({f, s, fields[f].weeds_per_m2});
  }
  // The long ones first, so that no thread is left alone with one at the end.
  std::stable_sort(tasks.begin(), tasks.end(),
                   [](const Task& a, const Task& b) { return a.weeds > b.weeds; });

  std::mutex mutex;
  double done = 0.0;
  double total = 0.0;
  for (const Task& task : tasks) total += task.weeds * static_cast<double>(variants.size());
  std::vector<std::optional<Error>> errors(tasks.size());
  parallel_for(tasks.size(), threads, [&](std::size_t t) {
    const Task& task = tasks[t];
    const std::function<void()> step = [&] {
      const std::lock_guard lock(mutex);
      done += task.weeds;
      if (progress && total > 0.0) progress(done / total);
    };
    const auto seed = static_cast<std::uint64_t>(sampling.first_seed) + task.seed;
    auto driven = Unit(variants, step).run(fields[task.field], sampling.row, seed);
    if (!driven.ok()) {
      errors[t] = driven.error();
      return;
    }
    for (std::size_t v = 0; v < variants.size(); ++v) {
      figures[task.field][v][task.seed] = std::move((*driven)[v]);
    }
  });
  for (const auto& error : errors) {
    if (error) return *error;
  }
  return figures;
}

EvaluationRow summarize(const FieldCase& field, const Variant& variant,
                        const std::vector<DriveFigures>& figures) {
  std::vector<double> losses;
  std::vector<double> optima;
  std::vector<double> travels;
  std::vector<double> times;
  double weeds = 0.0;
  double treated = 0.0;
  double left_for_crop = 0.0;
  double outside = 0.0;
  double sprays = 0.0;
  for (const DriveFigures& drive : figures) {
    losses.push_back(drive.loss_pct());
    optima.push_back(drive.optimum_loss_pct());
    travels.insert(travels.end(), drive.travel_m.begin(), drive.travel_m.end());
    times.insert(times.end(), drive.replan_us.begin(), drive.replan_us.end());
    weeds += static_cast<double>(drive.weeds);
    treated += static_cast<double>(drive.treated);
    left_for_crop += static_cast<double>(drive.left_for_crop);
    outside += static_cast<double>(drive.outside);
    sprays += static_cast<double>(drive.sprays);
  }
  const MeanAndSpread travel = mean_and_sd(travels);
  EvaluationRow row;
  row.field = field.name;
  row.weeds_per_m2 = field.weeds_per_m2;
  row.kinematics = variant.planner.kinematics;
  row.assignment = variant.planner.assignment;
  row.planner = variant.planner.planner;
  row.view = variant.planner.view;
  row.loss_pct = mean_and_sd(losses).mean;
  row.loss_ci95 = ci95_half_width(losses);
  row.travel_m_mean = travel.mean;
  row.travel_m_sd = travel.sd;
  row.replan_p50_us = quantile(times, 0.5);
  row.replan_p99_us = quantile(std::move(times), 0.99);
  row.optimum_loss_pct = mean_and_sd(optima).mean;
  row.left_for_crop_pct = weeds > 0.0 ? 100.0 * left_for_crop / weeds : 0.0;
  if (variant.planner.planner == "footprint") {
    row.bound_loss_pct = weeds > 0.0 ? 100.0 * (left_for_crop + outside) / weeds : 0.0;
  }
  row.sprays_per_weed = treated > 0.0 ? sprays / treated : 0.0;
  return row;
}

}  // namespace furrow::experiments
