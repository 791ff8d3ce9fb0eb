#include <gtest/gtest.h>

#include <cmath>

#include "furrow_core/error.hpp"
#include "furrow_experiments/biodiversity_experiment.hpp"
#include "furrow_experiments/observation_experiment.hpp"
#include "furrow_experiments/planner_benchmark.hpp"

namespace furrow::experiments {
namespace {

SamplingParameters small_sampling() {
  SamplingParameters sampling;
  sampling.seeds = 3;
  sampling.row.length_m = 4.0;
  return sampling;
}

ObservationExperiment small_experiment() {
  ObservationExperiment experiment;
  experiment.planners = main_planner_choices();
  experiment.sampling = small_sampling();
  experiment.threads = 1;
  return experiment;
}

const EvaluationRow& row_of(const std::vector<EvaluationRow>& rows, const std::string& field,
                            const PlannerChoice& choice, const std::string& view) {
  for (const EvaluationRow& row : rows) {
    if (row.field == field && row.view == view && row.planner == choice.planner &&
        row.assignment == choice.assignment) {
      return row;
    }
  }
  throw std::out_of_range("no such row");
}

/// What does not depend on the clock.
std::vector<double> repeatable(const std::vector<EvaluationRow>& rows) {
  std::vector<double> values;
  for (const EvaluationRow& row : rows) {
    values.insert(values.end(), {row.loss_pct, row.loss_ci95, row.travel_m_mean, row.travel_m_sd,
                                 row.optimum_loss_pct, row.sprays_per_weed});
    if (row.priorities) {
      values.insert(values.end(),
                    {row.priorities->treated_low_pct, row.priorities->treated_high_pct});
    }
  }
  return values;
}

TEST(Observation, TheSameOnAnyNumberOfThreads) {
  ObservationExperiment experiment = small_experiment();
  const auto one = run(experiment);
  experiment.threads = 3;
  const auto three = run(experiment);
  ASSERT_TRUE(one.ok() && three.ok());
  EXPECT_EQ(one->rows.size(), 5U * 5U * 2U);
  EXPECT_EQ(repeatable(one->rows), repeatable(three->rows));
}

TEST(Observation, PlannersStandInTheirOrder) {
  const auto result = run(small_experiment());
  ASSERT_TRUE(result.ok());
  for (const FieldCase& field : paper_field_cases()) {
    const auto& joint = row_of(result->rows, field.name, {"exact", "joint"}, "rolling");
    const auto& divided = row_of(result->rows, field.name, {"exact", "static"}, "rolling");
    const auto& segment = row_of(result->rows, field.name, {"exact", "joint"}, "segment");
    const auto& footprint = row_of(result->rows, field.name, {"footprint", "joint"}, "rolling");
    EXPECT_GE(joint.loss_pct, joint.optimum_loss_pct - 1e-9);
    EXPECT_GE(segment.loss_pct, joint.optimum_loss_pct - 1e-9);
    EXPECT_GE(divided.loss_pct, joint.loss_pct - 1e-9);
    EXPECT_LE(footprint.loss_pct, joint.loss_pct + 1e-9);
    EXPECT_LE(footprint.sprays_per_weed, 1.0);
    EXPECT_DOUBLE_EQ(joint.sprays_per_weed, 1.0);
    EXPECT_EQ(joint.optimum_loss_pct, divided.optimum_loss_pct);
    EXPECT_FALSE(joint.bound_loss_pct.has_value());
    EXPECT_LE(footprint.bound_loss_pct.value(), footprint.loss_pct + 1e-9);
  }
}

TEST(Observation, PaperFiguresStandBesideTheirView) {
  const auto result = run(small_experiment());
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(row_of(result->rows, "sb20_s2_like", {"notsp", "static"}, "rolling").paper_loss_pct,
            6.4);
  EXPECT_EQ(row_of(result->rows, "sb20_s2_like", {"notsp", "static"}, "segment").paper_loss_pct,
            11.9);
}

TEST(Observation, NoWeedsNoLoss) {
  ObservationExperiment experiment = small_experiment();
  experiment.fields = {{"bare", 0.0, std::nullopt}};
  const auto result = run(experiment);
  ASSERT_TRUE(result.ok()) << result.error().message;
  for (const EvaluationRow& row : result->rows) {
    EXPECT_EQ(row.loss_pct, 0.0);
    EXPECT_EQ(row.travel_m_mean, 0.0);
    EXPECT_EQ(row.optimum_loss_pct, 0.0);
    EXPECT_FALSE(row.paper_loss_pct.has_value());
  }
}

TEST(Observation, ImportedFieldIsDrivenOnce) {
  field::FieldModel model;
  model.name = "imported";
  model.length_m = 2.0;
  model.width_m = 1.0;
  model.plants = {{.id = 4, .p_F_m = {0.5, 0.1}}, {.id = 9, .p_F_m = {1.5, -0.2}}};
  ObservationExperiment experiment = small_experiment();
  experiment.fields = {*imported_field_case(model)};
  EXPECT_DOUBLE_EQ(experiment.fields[0].weeds_per_m2, 1.0);
  const auto result = run(experiment);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->rows[0].loss_pct, 0.0);
  EXPECT_TRUE(std::isnan(result->rows[0].loss_ci95));
}

TEST(Observation, BadParametersThrow) {
  ObservationExperiment experiment = small_experiment();
  experiment.sampling.seeds = 0;
  EXPECT_THROW((void)run(experiment), ConfigError);
  experiment = small_experiment();
  experiment.setup.frame_period_s = std::nan("");
  EXPECT_THROW((void)run(experiment), ConfigError);
  experiment = small_experiment();
  experiment.views = {"sideways"};
  EXPECT_THROW((void)run(experiment), ConfigError);
  experiment = small_experiment();
  experiment.planner.omega = -1.0;
  EXPECT_THROW((void)run(experiment), ConfigError);
}

TEST(Observation, ProgressGrowsToOne) {
  ObservationExperiment experiment = small_experiment();
  experiment.fields.resize(2);
  experiment.sweep_seeds = 1;
  experiment.threads = 2;
  double last = 0.0;
  const auto result = run(experiment, [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  });
  ASSERT_TRUE(result.ok());
  EXPECT_NEAR(last, 1.0, 1e-9);
}

TEST(Sweep, EachStepHelpsOrHarms) {
  ObservationExperiment experiment = small_experiment();
  experiment.fields = {{"dense", 40.0, std::nullopt}};
  experiment.planners = {{"exact", "joint"}};
  experiment.sweep_seeds = 2;
  const auto result = run(experiment);
  ASSERT_TRUE(result.ok());
  ASSERT_FALSE(result->sweeps.empty());
  for (std::size_t i = 1; i < result->sweeps.size(); ++i) {
    const SweepPoint& before = result->sweeps[i - 1];
    const SweepPoint& after = result->sweeps[i];
    if (before.parameter != after.parameter) continue;
    EXPECT_LT(before.value, after.value);
    // The optimum can only lose by speed and gain by axes, velocity and trust in the timing. The
    // axes' places change with their number, which moves the optimum a little.
    const double slack_pct = after.parameter == "axes" ? 1.0 : 1e-9;
    const double worse = after.parameter == "speed_mps"
                             ? before.row.optimum_loss_pct - after.row.optimum_loss_pct
                             : after.row.optimum_loss_pct - before.row.optimum_loss_pct;
    EXPECT_LE(worse, slack_pct) << after.parameter << " " << after.value;
  }
}

TEST(Biodiversity, WeightsServeTheHighPriority) {
  BiodiversityExperiment experiment;
  EXPECT_EQ(experiment.planner.speed_mps, 1.0);
  experiment.fields = {{"sb21_s2_like", 81.2, std::nullopt}};
  experiment.planners = {{"exact", "static"}, {"exact", "joint"}};
  experiment.sampling = small_sampling();
  const auto result = run(experiment);
  ASSERT_TRUE(result.ok());
  ASSERT_EQ(result->rows.size(), 8U);
  for (std::size_t i = 0; i < result->rows.size(); i += 2) {
    const EvaluationRow& plain = result->rows[i];
    const EvaluationRow& weighted = result->rows[i + 1];
    EXPECT_EQ(plain.priorities->scheme, "plain");
    EXPECT_EQ(weighted.priorities->scheme, "biodiversity");
    EXPECT_GT(weighted.priorities->treated_high_pct, plain.priorities->treated_high_pct);
    EXPECT_LT(weighted.priorities->treated_low_pct, plain.priorities->treated_low_pct);
    EXPECT_EQ(weighted.priorities->paper_high_pct.has_value(), weighted.view == "rolling");
  }
}

TEST(Benchmark, CountsReplansAndTargets) {
  PlannerBenchmark benchmark;
  benchmark.fields = {{"some", 20.0, std::nullopt}};
  benchmark.planners = {{"exact", "joint"}};
  benchmark.sampling = small_sampling();
  benchmark.window_targets = {10, 50};
  const auto result = run(benchmark);
  ASSERT_TRUE(result.ok()) << result.error().message;
  ASSERT_EQ(result->stream.size(), 1U);
  EXPECT_GT(result->stream[0].replans, 100U);
  EXPECT_GT(result->stream[0].replan_p50_us, 0.0);
  EXPECT_GE(result->stream[0].replan_p99_us, result->stream[0].replan_p50_us);
  EXPECT_NEAR(result->stream[0].targets, 20.0 * 1.39, 1e-9);
  ASSERT_EQ(result->window.size(), 2U);
  EXPECT_FALSE(result->stream[0].allocations_per_replan.has_value()) << "nobody counted";
  benchmark.window_targets = {0};
  EXPECT_FALSE(run(benchmark).ok());
}

TEST(Benchmark, CountsAllocationsOfTheSteadyState) {
  PlannerBenchmark benchmark;
  benchmark.fields = {{"some", 20.0, std::nullopt}};
  benchmark.planners = {{"exact", "joint"}};
  benchmark.sampling = small_sampling();
  benchmark.window_targets = {10};
  std::uint64_t count = 0;
  benchmark.allocations = [&] { return count += 3; };  // as if each plan asked for memory so often
  const auto result = run(benchmark);
  ASSERT_TRUE(result.ok()) << result.error().message;
  EXPECT_DOUBLE_EQ(result->stream[0].allocations_per_replan.value(), 3.0);
  EXPECT_DOUBLE_EQ(result->window[0].allocations_per_replan.value(), 3.0);
}

TEST(Benchmark, FindsThePowerOfTheGrowth) {
  std::vector<BenchmarkRow> rows;
  for (const double targets : {10.0, 100.0, 1000.0, 10000.0}) {
    BenchmarkRow row;
    row.planner = "exact/joint";
    row.targets = targets;
    row.replan_p50_us = targets < 50.0 ? 1e6 : 0.5 * std::pow(targets, 1.5);
    rows.push_back(row);
  }
  EXPECT_NEAR(growth_exponent(rows, "exact/joint", 50.0), 1.5, 1e-9);
  EXPECT_TRUE(std::isnan(growth_exponent(rows, "exact/joint", 5000.0)));
  EXPECT_TRUE(std::isnan(growth_exponent(rows, "other", 0.0)));
}

}  // namespace
}  // namespace furrow::experiments
