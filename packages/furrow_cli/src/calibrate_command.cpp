#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "calibration_run.hpp"
#include "command.hpp"
#include "console.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/file.hpp"

namespace furrow::cli {
namespace {

using components::CalibratedNozzle;
using components::LandingOffsets;

struct CalibrateOptions {
  std::string graph = "weeding";
  std::vector<std::string> settings;
  int sprays = 12;
  int rounds = 2;
  std::uint64_t seed = 1;
  double limit_mm = 4.0;
  std::string measured;
  std::string out = "nozzles.yaml";
  std::string json;
};

/// One nozzle's way from what it was to what it is.
struct Row {
  std::string axis;
  std::size_t sprays = 0;
  double before_p95_mm = 0.0;
  double after_p95_mm = 0.0;
  actuation::NozzleCalibration before;
  actuation::NozzleCalibration after;
};

constexpr double kMmPerM = 1000.0;

double p95_mm(const LandingOffsets& landings, const std::string& axis) {
  const auto of_axis = landings.find(axis);
  if (of_axis == landings.end()) return NAN;
  const auto p95_m = actuation::distance_quantile_m(of_axis->second, 0.95);
  return p95_m ? kMmPerM * *p95_m : NAN;
}

/// The calibrations that the landings ask for. Throws when a nozzle's do not tell.
std::vector<CalibratedNozzle> fitted(std::vector<CalibratedNozzle> nozzles,
                                     const LandingOffsets& landings) {
  for (CalibratedNozzle& nozzle : nozzles) {
    const auto of_axis = landings.find(nozzle.axis);
    if (of_axis == landings.end()) {
      throw std::runtime_error("the nozzle of " + nozzle.axis + " left nothing on the ground");
    }
    const auto fit = actuation::fit_nozzle(nozzle.calibration, of_axis->second);
    if (!fit.ok()) {
      throw std::runtime_error("the nozzle of " + nozzle.axis +
                               " cannot be calibrated: " + fit.error().message);
    }
    nozzle.calibration = fit->calibration;
  }
  return nozzles;
}

std::string table_of(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> lines = {
      {"nozzle", "sprays", "open delay", "offset x", "offset y", "p95 before", "p95 after"}};
  for (const Row& row : rows) {
    lines.push_back({row.axis, std::to_string(row.sprays),
                     number(kMmPerM * row.before.open_delay_s, 2) + " -> " +
                         number(kMmPerM * row.after.open_delay_s, 2) + " ms",
                     number(kMmPerM * row.after.offset_x_m, 2) + " mm",
                     number(kMmPerM * row.after.offset_y_m, 2) + " mm",
                     number(row.before_p95_mm, 2) + " mm",
                     std::isnan(row.after_p95_mm) ? "-" : number(row.after_p95_mm, 2) + " mm"});
  }
  return text_table(lines);
}

std::string json_of(const std::vector<Row>& rows, const CalibrateOptions& options) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Row& row : rows) {
    list.push_back({{"axis", row.axis},
                    {"sprays", row.sprays},
                    {"p95_before_mm", row.before_p95_mm},
                    {"p95_after_mm", row.after_p95_mm},
                    {"open_delay_before_s", row.before.open_delay_s},
                    {"open_delay_s", row.after.open_delay_s},
                    {"close_delay_s", row.after.close_delay_s},
                    {"offset_x_m", row.after.offset_x_m},
                    {"offset_y_m", row.after.offset_y_m}});
  }
  const nlohmann::ordered_json document = {{"rows", std::move(list)},
                                           {"seed", options.seed},
                                           {"parameters",
                                            {{"graph", options.graph},
                                             {"settings", options.settings},
                                             {"sprays", options.sprays},
                                             {"rounds", options.rounds}}},
                                           {"version", FURROW_VERSION}};
  return document.dump(2) + "\n";
}

void write(const std::string& path, const std::string& text) {
  const Status written = write_file_atomically(path, text);
  if (!written.ok()) throw std::runtime_error(written.error().message);
}

/// By what somebody measured on paper; nozzles that were not measured stay as they are.
int calibrate_by_measurements(const CalibrateOptions& options, const PreparedGraph& prepared) {
  const LandingOffsets landings = components::load_landing_offsets(options.measured);
  const auto before = nozzles_of(prepared);
  std::vector<CalibratedNozzle> measured;
  for (const CalibratedNozzle& nozzle : before) {
    if (landings.contains(nozzle.axis)) measured.push_back(nozzle);
  }
  if (measured.size() != landings.size()) {
    throw ConfigError({options.measured, 0}, "axis", "names a nozzle that the graph does not have");
  }
  measured = fitted(std::move(measured), landings);
  std::vector<CalibratedNozzle> after = before;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const auto fit = std::ranges::find(measured, before[i].axis, &CalibratedNozzle::axis);
    if (fit == measured.end()) continue;
    after[i] = *fit;
    rows.push_back({before[i].axis, landings.at(before[i].axis).size(),
                    p95_mm(landings, before[i].axis), NAN, before[i].calibration,
                    fit->calibration});
  }
  std::cout << table_of(rows);
  if (!options.json.empty()) write(options.json, json_of(rows, options));
  write(options.out,
        components::nozzle_file_text(after, "Written by furrow calibrate from measured offsets."));
  std::cout << "calibration: " << options.out << '\n';
  return 0;
}

int calibrate(const CalibrateOptions& options) {
  if (std::filesystem::is_directory(options.out)) {
    throw ConfigError("--out: " + options.out + " is a folder");
  }
  const PreparedGraph prepared = prepare_graph(options.graph, options.settings);
  if (!options.measured.empty()) return calibrate_by_measurements(options, prepared);
  const PatternOptions pattern{.sprays = options.sprays, .seed = options.seed};
  const auto before = nozzles_of(prepared);
  const LandingOffsets first = run_pattern(prepared, before, pattern);
  auto nozzles = before;
  LandingOffsets landings = first;
  for (int round = 0; round < options.rounds; ++round) {
    nozzles = fitted(std::move(nozzles), landings);
    landings = run_pattern(prepared, nozzles, pattern);
  }
  std::vector<Row> rows;
  bool good = true;
  for (std::size_t i = 0; i < nozzles.size(); ++i) {
    const std::string& axis = nozzles[i].axis;
    rows.push_back({axis, landings[axis].size(), p95_mm(first, axis), p95_mm(landings, axis),
                    before[i].calibration, nozzles[i].calibration});
    good = good && rows.back().after_p95_mm <= options.limit_mm;
  }
  std::cout << table_of(rows);
  if (!options.json.empty()) write(options.json, json_of(rows, options));
  if (!good) {
    std::cerr << "furrow: a nozzle still lands more than " << number(options.limit_mm, 1)
              << " mm off (p95); nothing was written to " << options.out << '\n';
    return 1;
  }
  write(options.out, components::nozzle_file_text(
                         nozzles, "Written by furrow calibrate over a simulated test pattern."));
  std::cout << "calibration: " << options.out << '\n';
  return 0;
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CalibrateOptions>();
  CLI::App* command = app.add_subcommand(
      "calibrate",
      "Calibrates the nozzles by a test pattern, sprayed in the simulator or measured on paper.");
  command->add_option("--graph", options->graph, "graph file, or the name of a shipped one")
      ->capture_default_str();
  command
      ->add_option("--set", options->settings,
                   "COMPONENT.KEY=VALUE over the files; common.KEY=VALUE for all components")
      ->take_all();
  command->add_option("--sprays", options->sprays, "of each nozzle at each of three speeds")
      ->check(CLI::Range(2, 60))
      ->capture_default_str();
  command->add_option("--rounds", options->rounds, "of fitting and spraying again")
      ->check(CLI::Range(1, 10))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "of everything that is random")
      ->capture_default_str();
  command
      ->add_option("--limit-mm", options->limit_mm,
                   "a nozzle that lands farther off in the end (p95) is an error")
      ->check(CLI::Range(0.01, 1000.0))
      ->capture_default_str();
  command->add_option("--measured", options->measured,
                      "offsets measured on paper (axis,speed_mps,along_mm,across_mm) in place of "
                      "the simulator's");
  command->add_option("--out", options->out, "calibration file")->capture_default_str();
  command->add_option("--json", options->json, "the figures, for other programs");
  command->callback([options, &exit_code] { exit_code = calibrate(*options); });
}

}  // namespace furrow::cli
