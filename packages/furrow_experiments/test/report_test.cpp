#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "furrow_experiments/biodiversity_experiment.hpp"
#include "furrow_experiments/observation_experiment.hpp"
#include "furrow_experiments/paper_figures.hpp"
#include "furrow_experiments/planner_benchmark.hpp"

namespace furrow::experiments {
namespace {

using Json = nlohmann::json;

const std::set<std::string> kObservationKeys = {
    "field",         "weeds_per_m2",  "kinematics",     "assignment",       "planner",
    "view",          "loss_pct",      "loss_ci95",      "travel_m_mean",    "travel_m_sd",
    "replan_p50_us", "replan_p99_us", "paper_loss_pct", "optimum_loss_pct", "bound_loss_pct"};

std::set<std::string> keys_of(const Json& json) {
  std::set<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.insert(key);
  return keys;
}

template <class Experiment>
Experiment small() {
  Experiment experiment;
  experiment.fields.resize(2);
  experiment.planners = {{"notsp", "static"}, {"footprint", "joint"}};
  experiment.sampling.seeds = 1;
  experiment.sampling.first_seed = 7;
  experiment.sampling.row.length_m = 3.0;
  return experiment;
}

TEST(Json, ObservationHasItsKeys) {
  auto experiment = small<ObservationExperiment>();
  experiment.sweep_seeds = 1;
  const auto result = run(experiment);
  ASSERT_TRUE(result.ok());
  const Json json = Json::parse(to_json(experiment, *result, "1.2.3"));
  ASSERT_EQ(json["rows"].size(), 8U);
  for (const Json& row : json["rows"]) EXPECT_EQ(keys_of(row), kObservationKeys);
  EXPECT_TRUE(json["rows"][0]["loss_ci95"].is_null()) << "of one seed there is no interval";
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["version"], "1.2.3");
  EXPECT_EQ(json["parameters"]["omega"], 20.0);
  EXPECT_EQ(json["parameters"]["axes"], 4);
  EXPECT_EQ(json["parameters"]["length_m"], 3.0);
  EXPECT_EQ(json["sweeps"][0]["parameter"], "speed_mps");
}

TEST(Json, BiodiversityHasItsKeys) {
  const auto experiment = small<BiodiversityExperiment>();
  const auto result = run(experiment);
  ASSERT_TRUE(result.ok());
  const Json json = Json::parse(to_json(experiment, *result, "1.2.3"));
  std::set<std::string> expected = kObservationKeys;
  expected.insert(
      {"scheme", "treated_low_pct", "treated_high_pct", "paper_low_pct", "paper_high_pct"});
  ASSERT_EQ(json["rows"].size(), 16U);
  for (const Json& row : json["rows"]) EXPECT_EQ(keys_of(row), expected);
  EXPECT_EQ(json["parameters"]["speed_mps"], 1.0);
}

TEST(Json, BenchmarkHasItsKeys) {
  auto benchmark = small<PlannerBenchmark>();
  benchmark.window_targets = {20};
  const auto result = run(benchmark);
  ASSERT_TRUE(result.ok());
  const Json json = Json::parse(to_json(benchmark, *result, "1.2.3"));
  ASSERT_EQ(json["rows"].size(), 4U);
  EXPECT_EQ(keys_of(json["rows"][0]),
            (std::set<std::string>{"planner", "weeds_per_m2", "targets", "replan_p50_us",
                                   "replan_p99_us", "allocations_per_replan"}));
  EXPECT_EQ(json["window"].size(), 2U);
  EXPECT_NE(to_html(benchmark, *result, "1.2.3").find("<svg"), std::string::npos);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

TEST(Html, ObservationShowsTablesChartsAndRoutes) {
  auto experiment = small<ObservationExperiment>();
  experiment.routes = true;
  const auto result = run(experiment);
  ASSERT_TRUE(result.ok());
  ASSERT_EQ(result->routes.size(), 3U) << "nOTSP in both views, footprints in the rolling one";
  const std::string html = to_html(experiment, *result, "1.2.3");
  EXPECT_EQ(count(html, "<table"), 2U) << "one for each field";
  EXPECT_NE(html.find("paper (nOTSP, CN20)"), std::string::npos);
  EXPECT_NE(html.find("footprint/joint, rolling view"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(Html, BiodiversityShowsBothSchemes) {
  const auto experiment = small<BiodiversityExperiment>();
  const auto result = run(experiment);
  ASSERT_TRUE(result.ok());
  const std::string html = to_html(experiment, *result, "1.2.3");
  EXPECT_NE(html.find("high, biodiversity"), std::string::npos);
  EXPECT_NE(html.find("paper (CN20)"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(Html, NamesOfImportedFieldsAreEscaped) {
  field::FieldModel model;
  model.name = "<b>field</b>";
  model.length_m = 1.0;
  model.width_m = 1.0;
  model.plants = {{.id = 0, .p_F_m = {0.5, 0.1}}};
  auto experiment = small<ObservationExperiment>();
  experiment.fields = {*imported_field_case(model)};
  const auto result = run(experiment);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(to_html(experiment, *result, "1").find("<b>field"), std::string::npos);
}

TEST(RouteFigure, DrawsEachWeedOfTheStretch) {
  RouteExample example;
  example.title = "two weeds";
  example.field.length_m = 1.0;
  example.field.weeds = {{.id = 0, .p_F = {0.3, 0.0}}, {.id = 1, .p_F = {0.6, 0.9}}};
  example.field.high_priority = {false, false};
  example.to_x_m = 1.0;
  auto driven = drive(example.field, {}, {});
  ASSERT_TRUE(driven.ok()) << driven.error().message;
  example.drive = *driven;
  const std::string svg = to_svg(example);
  EXPECT_NE(svg.find("1 of 2 weeds missed here"), std::string::npos) << "one is beyond the span";
  EXPECT_EQ(count(svg, "<circle"), 3U) << "two weeds and a footprint";
  EXPECT_EQ(count(svg, "<polyline"), 4U) << "one for each axis";
}

TEST(PlannerChoice, NamesThatDoNotExistAreRefused) {
  EXPECT_EQ(to_string(*planner_choice_from("exact/joint")), "exact/joint");
  EXPECT_EQ(to_string(*planner_choice_from("footprint")), "footprint/joint");
  for (const char* bad : {"", "exact", "footprint/static", "exact/joint/x"}) {
    const auto refused = planner_choice_from(bad);
    ASSERT_FALSE(refused.ok()) << bad;
    EXPECT_NE(refused.error().message.find("greedy/static"), std::string::npos);
  }
}

TEST(PaperFigures, GainOfTheRollingViewIsThePapers) {
  // "a maximum and minimum absolute improvement of 5.5 % on SB20 and 1.7 % on SB21-S2".
  EXPECT_NEAR(paper_figures("sb20_s2_like")->segment_loss_pct -
                  paper_figures("sb20_s2_like")->rolling_loss_pct,
              5.5, 1e-9);
  EXPECT_NEAR(paper_figures("sb21_s2_like")->segment_loss_pct -
                  paper_figures("sb21_s2_like")->rolling_loss_pct,
              1.7, 1e-9);
  EXPECT_EQ(paper_figures("imported"), nullptr);
}

}  // namespace
}  // namespace furrow::experiments
