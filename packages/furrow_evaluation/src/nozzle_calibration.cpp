#include "furrow_evaluation/nozzle_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "furrow_actuation/nozzle_fit.hpp"
#include "furrow_core/error.hpp"
#include "furrow_core/text.hpp"

namespace furrow::evaluation {
namespace {

using components::CalibratedNozzle;
using components::LandingOffsets;

constexpr double kMmPerM = 1000.0;

double p95_mm(const LandingOffsets& landings, const std::string& axis) {
  const auto of_axis = landings.find(axis);
  if (of_axis == landings.end()) return NAN;
  const auto p95_m = actuation::distance_quantile_m(of_axis->second, 0.95);
  return p95_m ? kMmPerM * *p95_m : NAN;
}

/// The calibrations that the landings ask for.
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

std::string mm(double value_m) {
  return fixed(kMmPerM * value_m, 2) + " mm";
}

}  // namespace

NozzleCalibrationResult calibrate_in_simulator(const launch::PreparedGraph& prepared,
                                               const PatternOptions& pattern, int rounds) {
  const auto before = nozzles_of(prepared);
  const LandingOffsets first = run_pattern(prepared, before, pattern);
  NozzleCalibrationResult result{.nozzles = before, .rows = {}};
  LandingOffsets landings = first;
  for (int round = 0; round < rounds; ++round) {
    result.nozzles = fitted(std::move(result.nozzles), landings);
    landings = run_pattern(prepared, result.nozzles, pattern);
  }
  for (std::size_t i = 0; i < before.size(); ++i) {
    const std::string& axis = before[i].axis;
    result.rows.push_back({axis, landings[axis].size(), p95_mm(first, axis), p95_mm(landings, axis),
                           before[i].calibration, result.nozzles[i].calibration});
  }
  return result;
}

NozzleCalibrationResult calibrate_by_measurements(const launch::PreparedGraph& prepared,
                                                  const std::filesystem::path& offsets) {
  const LandingOffsets landings = components::load_landing_offsets(offsets);
  NozzleCalibrationResult result{.nozzles = nozzles_of(prepared), .rows = {}};
  std::vector<CalibratedNozzle> measured;
  for (const CalibratedNozzle& nozzle : result.nozzles) {
    if (landings.contains(nozzle.axis)) measured.push_back(nozzle);
  }
  if (measured.size() != landings.size()) {
    throw ConfigError({offsets.string(), 0}, "axis", "names a nozzle that the graph does not have");
  }
  measured = fitted(std::move(measured), landings);
  for (CalibratedNozzle& nozzle : result.nozzles) {
    const auto fit = std::ranges::find(measured, nozzle.axis, &CalibratedNozzle::axis);
    if (fit == measured.end()) continue;
    result.rows.push_back({nozzle.axis, landings.at(nozzle.axis).size(),
                           p95_mm(landings, nozzle.axis), NAN, nozzle.calibration,
                           fit->calibration});
    nozzle = *fit;
  }
  return result;
}

std::string to_table(const std::vector<NozzleCalibrationRow>& rows) {
  std::vector<std::vector<std::string>> lines = {
      {"nozzle", "sprays", "open delay", "offset x", "offset y", "p95 before", "p95 after"}};
  for (const NozzleCalibrationRow& row : rows) {
    lines.push_back({row.axis, std::to_string(row.sprays),
                     fixed(kMmPerM * row.before.open_delay_s, 2) + " -> " +
                         fixed(kMmPerM * row.after.open_delay_s, 2) + " ms",
                     mm(row.after.offset_x_m), mm(row.after.offset_y_m),
                     fixed(row.before_p95_mm, 2) + " mm",
                     std::isnan(row.after_p95_mm) ? "-" : fixed(row.after_p95_mm, 2) + " mm"});
  }
  return text_table(lines);
}

std::string to_json(const std::vector<NozzleCalibrationRow>& rows,
                    const NozzleCalibrationParameters& parameters, std::string_view version) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const NozzleCalibrationRow& row : rows) {
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
                                           {"seed", parameters.seed},
                                           {"parameters",
                                            {{"graph", parameters.graph},
                                             {"settings", parameters.settings},
                                             {"sprays", parameters.sprays},
                                             {"rounds", parameters.rounds}}},
                                           {"version", version}};
  return document.dump(2) + "\n";
}

}  // namespace furrow::evaluation
