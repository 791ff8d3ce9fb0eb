#include "experiment_options.hpp"

#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "furrow_components/field_source.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"
#include "share.hpp"

namespace furrow::cli {
namespace {

constexpr std::int64_t kQuickSeeds = 4;
constexpr double kQuickLength_m = 8.0;

void write_result(const std::string& file, const std::string& text) {
  if (file.empty()) return;
  if (const Status written = write_file_atomically(file, text); !written.ok()) {
    throw std::runtime_error(written.error().message);
  }
  std::cout << file << '\n';
}

}  // namespace

void add_experiment_options(CLI::App* command, ExperimentOptions& options) {
  command->add_option("--seeds", options.sampling.seeds, "generated fields for each density")
      ->capture_default_str();
  command->add_option("--seed", options.sampling.first_seed, "of the first field")
      ->capture_default_str();
  command->add_option("--length", options.sampling.row.length_m, "of a generated row, m")
      ->capture_default_str();
  command->add_flag("--crop", options.sampling.row.crop, "generated rows have crop in them");
  command->add_option("--pattern", options.sampling.row.pattern, "of the weeds in generated rows")
      ->check(CLI::IsMember({"poisson", "clusters"}))
      ->capture_default_str();
  command->add_option("--planners", options.planners,
                      "PLANNER/ASSIGNMENT, such as exact/joint; or all, or main");
  command->add_option("--views", options.views, "observation models")
      ->check(CLI::IsMember({"segment", "rolling"}))
      ->capture_default_str();
  command->add_option("--field", options.fields,
                      "plants as CSV or GeoJSON, instead of the generated densities");
  command->add_option("--speed", options.planner.speed_mps, "of the robot, m/s")
      ->capture_default_str();
  command->add_option("--kinematics", options.planner.kinematics, "of the axes")
      ->check(CLI::IsMember({"velocity", "trapezoid"}))
      ->capture_default_str();
  command->add_option("--rho", options.planner.rho, "cutoff on the feasibility")
      ->capture_default_str();
  command->add_option("--omega", options.planner.omega, "steepness of the feasibility, 1/s")
      ->capture_default_str();
  command
      ->add_option("--protection-zone", options.planner.protection_zone_mm,
                   "between a footprint's rim and a crop's stem, mm")
      ->capture_default_str();
  command
      ->add_option("--segment-length", options.planner.segment_length_m, "of the segment view, m")
      ->capture_default_str();
  command->add_flag("--fire-while-moving", options.planner.fire_while_moving,
                    "nozzles may fire in passing");
  command->add_option("--axes", options.setup.axes, "number of axes")->capture_default_str();
  command->add_option("--axis-velocity", options.setup.axis_velocity_mps, "m/s")
      ->capture_default_str();
  command->add_option("--axis-acceleration", options.setup.axis_acceleration_mps2, "m/s2")
      ->capture_default_str();
  command->add_option("--frame-period", options.setup.frame_period_s, "between observations, s")
      ->capture_default_str();
  command
      ->add_option("--look-ahead", options.setup.look_ahead_m,
                   "how far before the first axis plants are seen, m")
      ->capture_default_str();
  command->add_option("--threads", options.threads, "0: as many as the machine has")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  command->add_flag("--quick", options.quick, "fewer and shorter fields; the main planners");
  command->add_option("--json", options.json, "file of the results");
  command->add_option("--html", options.html, "file of the report");
  command->parse_complete_callback([&options, command] {
    if (!options.quick) return;
    if (command->count("--seeds") == 0) options.sampling.seeds = kQuickSeeds;
    if (command->count("--length") == 0) options.sampling.row.length_m = kQuickLength_m;
    if (command->count("--planners") == 0) options.planners = {"main"};
  });
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
  const auto species = components::load_species(share_folder() / "params" / "species.yaml");
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

void write_results(const ExperimentOptions& options, const std::string& json,
                   const std::string& html) {
  write_result(options.json, json);
  write_result(options.html, html);
}

}  // namespace furrow::cli
