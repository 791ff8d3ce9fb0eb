#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_evaluation/trial_pace.hpp"
#include "furrow_ledger/ledger.hpp"

namespace furrow::evaluation {

/// One stretch of the trial.
struct TrialRegion {
  std::string field;  ///< a shipped preset, for its density
  bool crop = true;
};

/// The paper's field trial in the simulator, closed loop: stretches with weeds alone and with crop,
/// from low to high density.
struct TrialExperiment {
  std::vector<TrialRegion> regions = {{"cn20_like", false},    {"sb20_s1_like", false},
                                      {"sb21_s1_like", false}, {"cn20_like", true},
                                      {"sb20_s1_like", true},  {"sb21_s1_like", true}};
  std::string graph = "weeding_rtk";
  /// Wind on the spray and on the leaves and jitter of the valves, over the graph's parameters.
  std::vector<std::string> conditions = {
      "robot.spray_delay_jitter_s=0.001", "robot.spray_drift_x_mps=0.03",
      "robot.spray_drift_y_mps=0.05", "camera.render_leaf_sway_m=0.003"};
  /// That the planner asks for the robot's speed; else the robot keeps its own. With time to spend,
  /// the planner may be keener on the middle of a footprint.
  bool governed = true;
  std::vector<std::string> governing = {"planner.govern_speed=true",
                                        "robot.follow_speed_requests=true",
                                        "planner.centre_preference=0.6"};
  double length_m = 12.0;  ///< of each region
  std::uint64_t seed = 1;  ///< each region draws from a seed of its own, which follows from it
  int threads = 2;
  std::vector<std::string> settings;           ///< over the conditions
  std::filesystem::path folder = "out/trial";  ///< of the fields and of the regions' reports
};

struct TrialRow {
  std::string region;  ///< "weed_only", "crop_weed", "all"
  std::int64_t weeds_total = 0;
  std::int64_t accurate = 0;
  std::int64_t partial = 0;
  std::int64_t missed = 0;
  std::int64_t missed_vision = 0;
  std::int64_t missed_planning = 0;
  std::int64_t crops_total = 0;
  std::int64_t crops_hit = 0;
  double loss_pct = 0.0;
  double paper_loss_pct = 0.0;
  double way_m = 0.0;  ///< of the base over the fields, in time_s
  double time_s = 0.0;
  double area_m2 = 0.0;
};

struct TrialStretch {
  TrialRegion region;
  std::uint64_t seed = 0;
  double area_m2 = 0.0;
  std::string report;  ///< folder of its report
  ledger::Summary summary;
  Pace pace;
  std::string map_svg;
};

struct TrialResult {
  std::vector<TrialRow> rows;
  std::vector<TrialStretch> stretches;
};

/// What the trial sets beyond the graph's files, in the order in which it does.
[[nodiscard]] std::vector<std::string> all_settings(const TrialExperiment& experiment);
[[nodiscard]] double mean_speed_mps(double way_m, double time_s);
/// Hectares an hour while it drives in the row.
[[nodiscard]] double area_rate_ha_per_h(double area_m2, double time_s);

/// Throws ConfigError for what is asked wrongly, std::runtime_error when a run fails.
[[nodiscard]] TrialResult run(const TrialExperiment& experiment,
                              const std::function<void(double)>& progress);

[[nodiscard]] std::string to_table(const TrialResult& result);
[[nodiscard]] std::string to_json(const TrialExperiment& experiment, const TrialResult& result,
                                  std::string_view version);
[[nodiscard]] std::string to_html(const TrialExperiment& experiment, const TrialResult& result,
                                  std::string_view version);

}  // namespace furrow::evaluation
