#include "furrow_evaluation/tracking_experiment.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <tuple>

#include "furrow_configuration/graph_file.hpp"
#include "furrow_core/statistics.hpp"
#include "furrow_launch/graph_setup.hpp"
#include "furrow_launch/installation.hpp"

namespace furrow::evaluation {
namespace {

/// Of several logs, one value for each.
struct Counts {
  std::vector<std::int64_t> all;
  std::vector<std::int64_t> visible;
  std::vector<std::int64_t> counted;
  void add(const PlantCounts& counts) {
    all.push_back(counts.all);
    visible.push_back(counts.visible);
    counted.push_back(counts.counted);
  }
};

/// Results of several logs under one choice, summed up.
class Pool {
 public:
  void add(const ReplayResult& result) {
    crops_.add(result.crops);
    weeds_.add(result.weeds);
    const auto weight = static_cast<double>(result.scores.truth_points);
    weight_ += weight;
    mota_ += weight * result.scores.mota;
    idf1_ += weight * result.scores.idf1;
    hota_ += weight * result.scores.hota;
    row_.id_switches += result.scores.id_switches;
    row_.plants += result.crops.all + result.weeds.all;
    row_.plants_visible += result.crops.visible + result.weeds.visible;
    row_.plants_located += static_cast<std::int64_t>(result.stem_errors_mm.size());
    row_.frames += static_cast<std::int64_t>(result.position_errors_mm.size());
    row_.frames_without_pose += result.frames_without_pose;
    append(stems_, result.stem_errors_mm);
    append(positions_, result.position_errors_mm);
    append(headings_, result.heading_errors_rad);
  }

  [[nodiscard]] TrackingRow row(const std::string& field, const std::string& association,
                                PoseSource pose) {
    TrackingRow row = row_;
    row.field = field;
    row.association = association;
    row.localization = to_string(pose);
    row.nae_crop_pct = tracking::count_nae_pct(crops_.visible, crops_.counted).value();
    row.nae_weed_pct = tracking::count_nae_pct(weeds_.visible, weeds_.counted).value();
    row.nae_crop_all_pct = tracking::count_nae_pct(crops_.all, crops_.counted).value();
    row.nae_weed_all_pct = tracking::count_nae_pct(weeds_.all, weeds_.counted).value();
    row.mota = mota_ / weight_;
    row.idf1 = idf1_ / weight_;
    row.hota = hota_ / weight_;
    row.stem_p50_mm = quantile(stems_, 0.50);
    row.stem_p95_mm = quantile(stems_, 0.95);
    row.pose_rms_mm = rms(positions_);
    row.heading_rms_deg = rms(headings_) * 180.0 / std::numbers::pi;
    return row;
  }

 private:
  static void append(std::vector<double>& to, const std::vector<double>& from) {
    to.insert(to.end(), from.begin(), from.end());
  }
  static double rms(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value * value;
    return values.empty() ? NAN : std::sqrt(sum / static_cast<double>(values.size()));
  }

  TrackingRow row_;
  double weight_ = 0.0;
  double mota_ = 0.0;
  double idf1_ = 0.0;
  double hota_ = 0.0;
  Counts crops_;
  Counts weeds_;
  std::vector<double> stems_;
  std::vector<double> positions_;
  std::vector<double> headings_;
};

geometry::ToolModel tool_of(const SensingOptions& options) {
  const launch::PreparedGraph prepared = launch::prepare_graph(options.graph, options.settings);
  geometry::ToolModel tool =
      geometry::load_tool_model(configuration::common_text(prepared.spec, "tool_file"));
  if (tool.cameras.empty()) throw ConfigError("the tool has no camera");
  return tool;
}

}  // namespace

std::vector<TrackingRow> run(const TrackingExperiment& experiment, const ShareDone& progress) {
  // By the place of the association and of the pose, so that the rows keep that order.
  using Key = std::pair<std::size_t, std::size_t>;
  std::map<Key, Pool> all;
  std::vector<TrackingRow> rows;
  const auto rows_of = [&](std::map<Key, Pool>& pools, const std::string& field) {
    for (auto& [key, pool] : pools) {
      rows.push_back(
          pool.row(field, experiment.associations[key.first], experiment.poses[key.second]));
    }
  };
  const double parts =
      static_cast<double>(experiment.fields.size()) * static_cast<double>(experiment.seeds);
  double done = 0.0;
  for (const std::string& field : experiment.fields) {
    std::map<Key, Pool> pools;
    for (std::int64_t i = 0; i < experiment.seeds; ++i) {
      SensingOptions sensing;
      sensing.settings = {
          "common.field_file=" +
              std::filesystem::absolute(launch::find_shipped(field, "fields")).string(),
          "common.length_m=" + std::to_string(experiment.length_m)};
      sensing.settings.insert(sensing.settings.end(), experiment.settings.begin(),
                              experiment.settings.end());
      sensing.seed = experiment.first_seed + static_cast<std::uint64_t>(i);
      sensing.threads = experiment.threads;
      sensing.progress = [&](double share) { progress((done + share) / parts); };
      const geometry::ToolModel tool = tool_of(sensing);
      const SensingLog log = record_sensing(sensing);
      for (std::size_t a = 0; a < experiment.associations.size(); ++a) {
        for (std::size_t p = 0; p < experiment.poses.size(); ++p) {
          ReplayOptions replay = experiment.replay;
          replay.pose = experiment.poses[p];
          replay.tracker.association = experiment.associations[a];
          replay.observation.footprints = replay.tracker.association == "iou";
          const ReplayResult result = replay_tracking(log, tool.cameras.front(), replay);
          pools[{a, p}].add(result);
          all[{a, p}].add(result);
        }
      }
      done += 1.0;
    }
    rows_of(pools, field);
  }
  if (experiment.fields.size() > 1) rows_of(all, "all");
  return rows;
}

}  // namespace furrow::evaluation
