#include "experiment_options.hpp"

#include <filesystem>
#include <utility>

#include "furrow_components/field_source.hpp"
#include "furrow_core/error.hpp"
#include "furrow_launch/installation.hpp"

namespace furrow::cli {
namespace {

constexpr std::int64_t kQuickSeeds = 4;
constexpr double kQuickLength_m = 8.0;

void add_field_options(Command command, ExperimentOptions& options) {
  command.option("--seeds", options.sampling.seeds, "generated fields for each density")
      .at_least(1);
  command.option("--seed", options.sampling.first_seed, "seed of the first field");
  command.option("--length", options.sampling.row.length_m, "length of a generated row, m")
      .positive();
  command.flag("--crop", options.sampling.row.crop, "generated rows contain crop");
  command.option("--pattern", options.sampling.row.pattern, "pattern of the weeds in the rows")
      .choices({"poisson", "clusters"});
  command.option("--field", options.fields,
                 "plants as CSV or GeoJSON in place of the generated densities");
}

void add_planner_options(Command command, ExperimentOptions& options) {
  planning::PlannerParameters& planner = options.planner;
  command.option("--planners", options.planners,
                 "PLANNER/ASSIGNMENT, such as exact/joint; or all, or main");
  command.option("--views", options.views, "observation models").choices({"segment", "rolling"});
  command.option("--speed", planner.speed_mps, "speed of the robot, m/s");
  command.option("--kinematics", planner.kinematics, "kinematics of the axes")
      .choices({"velocity", "trapezoid"});
  command.option("--rho", planner.rho, "cutoff of the feasibility");
  command.option("--omega", planner.omega, "steepness of the feasibility, 1/s");
  command.option("--protection-zone", planner.protection_zone_mm,
                 "least distance from a footprint's rim to a crop's stem, mm");
  command.option("--segment-length", planner.segment_length_m, "length of a segment, m");
  command.flag("--fire-while-moving", planner.fire_while_moving,
               "nozzles may fire while their axis moves");
}

void add_setup_options(Command command, ExperimentOptions& options) {
  experiments::SetupParameters& setup = options.setup;
  command.option("--axes", setup.axes, "number of axes");
  command.option("--axis-velocity", setup.axis_velocity_mps, "velocity of an axis, m/s");
  command.option("--axis-acceleration", setup.axis_acceleration_mps2,
                 "acceleration of an axis, m/s2");
  command.option("--frame-period", setup.frame_period_s, "time between observations, s");
  command.option("--look-ahead", setup.look_ahead_m,
                 "distance before the first axis at which plants come into view, m");
  command.option("--threads", options.threads, "worker threads; 0: one for each processor")
      .range(0, 256);
}

}  // namespace

void add_experiment_options(Command command, ExperimentOptions& options) {
  add_field_options(command, options);
  add_planner_options(command, options);
  add_setup_options(command, options);
  command.flag("--quick", options.quick, "fewer and shorter fields; the main planners");
  add_result_options(command, options.results, true);
}

void apply_quick(Command command, ExperimentOptions& options) {
  if (!options.quick) return;
  if (!command.given("--seeds")) options.sampling.seeds = kQuickSeeds;
  if (!command.given("--length")) options.sampling.row.length_m = kQuickLength_m;
  if (!command.given("--planners")) options.planners = {"main"};
}

std::vector<experiments::PlannerChoice> chosen_planners(const ExperimentOptions& options) {
  if (options.planners.empty()) return experiments::all_planner_choices();
  std::vector<experiments::PlannerChoice> choices;
  for (const std::string& name : options.planners) {
    if (name == "all" || name == "main") {
      const auto list =
          name == "all" ? experiments::all_planner_choices() : experiments::main_planner_choices();
      choices.insert(choices.end(), list.begin(), list.end());
      continue;
    }
    const auto choice = experiments::planner_choice_from(name);
    if (!choice.ok()) throw ConfigError("--planners: " + choice.error().message);
    choices.push_back(*choice);
  }
  return choices;
}

std::vector<experiments::FieldCase> chosen_fields(const ExperimentOptions& options) {
  if (options.fields.empty()) return experiments::paper_field_cases();
  const auto species = components::load_species(launch::share_folder() / "params" / "species.yaml");
  std::vector<experiments::FieldCase> cases;
  for (const std::string& file : options.fields) {
    const std::string extension = std::filesystem::path(file).extension().string();
    if (extension != ".csv" && extension != ".geojson") {
      throw ConfigError("--field: " + file + " must end in .csv or .geojson");
    }
    auto field = experiments::imported_field_case(components::load_field(file, species, 0.0, 0));
    if (!field.ok()) throw ConfigError("--field: " + field.error().message);
    cases.push_back(std::move(*field));
  }
  return cases;
}

}  // namespace furrow::cli
