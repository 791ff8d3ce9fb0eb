#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <variant>

#include "furrow_experiments/biodiversity_experiment.hpp"
#include "furrow_experiments/observation_experiment.hpp"
#include "furrow_experiments/planner_benchmark.hpp"

namespace furrow::experiments {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kIndent = 1;

Json optional(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

template <class Parameters>
void add_parameters(Json& json, Parameters parameters) {
  ParameterLister lister;
  parameters.visit(lister);
  for (const DeclaredParameter& declared : lister.declared()) {
    std::visit([&](const auto& value) { json[declared.info.name] = value; },
               declared.default_value);
  }
}

/// With the keys of `furrow eval`. What is not a number becomes null.
Json row_json(const EvaluationRow& row) {
  Json json = {{"field", row.field},
               {"weeds_per_m2", row.weeds_per_m2},
               {"kinematics", row.kinematics},
               {"assignment", row.assignment},
               {"planner", row.planner},
               {"view", row.view},
               {"loss_pct", row.loss_pct},
               {"loss_ci95", row.loss_ci95},
               {"travel_m_mean", row.travel_m_mean},
               {"travel_m_sd", row.travel_m_sd},
               {"replan_p50_us", row.replan_p50_us},
               {"replan_p99_us", row.replan_p99_us},
               {"paper_loss_pct", optional(row.paper_loss_pct)},
               {"optimum_loss_pct", row.optimum_loss_pct},
               {"bound_loss_pct", optional(row.bound_loss_pct)}};
  if (row.priorities) {
    json["scheme"] = row.priorities->scheme;
    json["treated_low_pct"] = row.priorities->treated_low_pct;
    json["treated_high_pct"] = row.priorities->treated_high_pct;
    json["paper_low_pct"] = optional(row.priorities->paper_low_pct);
    json["paper_high_pct"] = optional(row.priorities->paper_high_pct);
  }
  return json;
}

Json row_json(const SweepPoint& point) {
  Json json = {{"parameter", point.parameter}, {"value", point.value}};
  json.update(row_json(point.row));
  return json;
}

Json row_json(const BenchmarkRow& row) {
  return {{"planner", row.planner},
          {"weeds_per_m2", row.weeds_per_m2},
          {"targets", row.targets},
          {"replan_p50_us", row.replan_p50_us},
          {"replan_p99_us", row.replan_p99_us},
          {"allocations_per_replan", optional(row.allocations_per_replan)}};
}

template <class Rows>
Json all_rows(const Rows& rows) {
  Json list = Json::array();
  for (const auto& row : rows) list.push_back(row_json(row));
  return list;
}

/// By name, but for those that the rows name.
Json parameters_json(const planning::PlannerParameters& planner, const SetupParameters& setup,
                     const SamplingParameters& sampling) {
  Json json = Json::object();
  add_parameters(json, planner);
  for (const char* of_rows : {"planner", "assignment", "view", "kinematics"}) json.erase(of_rows);
  add_parameters(json, setup);
  add_parameters(json, sampling);
  return json;
}

/// What follows the rows of every experiment.
void add_provenance(Json& json, const planning::PlannerParameters& planner,
                    const SetupParameters& setup, const SamplingParameters& sampling,
                    std::string_view version) {
  json["seed"] = sampling.first_seed;
  json["parameters"] = parameters_json(planner, setup, sampling);
  json["version"] = version;
}

}  // namespace

std::string to_json(const ObservationExperiment& experiment, const ObservationResult& result,
                    std::string_view version) {
  Json json = {{"rows", all_rows(result.rows)}, {"sweeps", all_rows(result.sweeps)}};
  add_provenance(json, experiment.planner, experiment.setup, experiment.sampling, version);
  return json.dump(kIndent) + "\n";
}

std::string to_json(const BiodiversityExperiment& experiment, const BiodiversityResult& result,
                    std::string_view version) {
  Json json = {{"rows", all_rows(result.rows)}};
  add_provenance(json, experiment.planner, experiment.setup, experiment.sampling, version);
  return json.dump(kIndent) + "\n";
}

std::string to_json(const PlannerBenchmark& benchmark, const BenchmarkResult& result,
                    std::string_view version) {
  Json json = {{"rows", all_rows(result.stream)}, {"window", all_rows(result.window)}};
  add_provenance(json, benchmark.planner, benchmark.setup, benchmark.sampling, version);
  return json.dump(kIndent) + "\n";
}

}  // namespace furrow::experiments
