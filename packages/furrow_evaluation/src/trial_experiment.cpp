#include "furrow_evaluation/trial_experiment.hpp"

#include <map>
#include <memory>
#include <stdexcept>

#include "furrow_components/field_conversion.hpp"
#include "furrow_components/field_source.hpp"
#include "furrow_components/run_record_conversion.hpp"
#include "furrow_configuration/parameter_file.hpp"
#include "furrow_core/file.hpp"
#include "furrow_core/version.hpp"
#include "furrow_field/field_csv.hpp"
#include "furrow_field/generator.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_launch/graph_setup.hpp"
#include "furrow_launch/installation.hpp"
#include "furrow_launch/run_observer.hpp"
#include "furrow_launch/run_summary.hpp"
#include "furrow_ledger/report.hpp"
#include "furrow_msgs/furrow_msgs.h"

namespace furrow::evaluation {
namespace {

template <class T>
T value_or_throw(Result<T> result) {
  if (!result.ok()) throw std::runtime_error(result.error().message);
  return std::move(result).value();
}

std::string name_of(const TrialRegion& region) {
  return std::string(region.crop ? "crop_weed_" : "weed_only_") + region.field;
}

std::filesystem::path write_field(const TrialExperiment& experiment, const TrialRegion& region,
                                  std::uint64_t seed) {
  auto parameters = configuration::load_parameter_file<field::FieldParameters>(
      launch::find_shipped(region.field, "fields"));
  parameters.crop = region.crop;
  parameters.length_m = experiment.length_m;
  const auto species = components::load_species(launch::share_folder() / "params" / "species.yaml");
  const auto field = value_or_throw(field::generate_field(parameters, species, seed));
  const auto file =
      std::filesystem::absolute(experiment.folder / "fields" / (name_of(region) + ".csv"));
  const Status written = write_file_atomically(file, value_or_throw(field::to_csv(field)));
  if (!written.ok()) throw std::runtime_error(written.error().message);
  return file;
}

TrialStretch run_stretch(const TrialExperiment& experiment, const TrialRegion& region,
                         std::uint64_t seed, const std::function<void(double)>& progress) {
  std::vector<std::string> settings = {
      "common.field_file=" + write_field(experiment, region, seed).string(),
      "common.length_m=" + std::to_string(experiment.length_m)};
  const std::vector<std::string> all = all_settings(experiment);
  settings.insert(settings.end(), all.begin(), all.end());
  launch::PreparedGraph prepared = launch::prepare_graph(experiment.graph, settings);
  graph::Registry registry = launch::make_registry();
  launch::RunObserver observer(
      [&progress](const furrow_msgs::msg::RunStatus& status) { progress(status.progress()); },
      launch::RunEnd::kRecord);
  observer.add_to(prepared.spec, registry);
  PaceObserver pace(experiment.length_m);
  pace.add_to(prepared.spec, registry);
  graph::Runtime runtime(prepared.spec, registry,
                         {.clock = graph::ClockMode::kLockstep,
                          .threads = experiment.threads,
                          .seed = seed,
                          .components = {},
                          .transport = nullptr});
  const graph::RunResult result = runtime.run();
  if (result.failed || observer.record() == nullptr) {
    throw std::runtime_error(name_of(region) + ": the run ended early: " + result.reason);
  }
  const auto field = components::from_msg(observer.record()->field());
  ledger::RunRecord record =
      value_or_throw(components::from_msg(*observer.record(), prepared.tool.axes));
  record.info.simulated = true;
  record.info.seed = static_cast<std::int64_t>(seed);
  record.info.version = version();
  record.info.graph = prepared.spec.name;
  record.tables = launch::health_tables(runtime.status(), false);
  const auto ledger = value_or_throw(ledger::account(field, record));
  const auto folder = experiment.folder / name_of(region);
  if (const Status written = ledger::write_run_files(folder, ledger, record); !written.ok()) {
    throw std::runtime_error(written.error().message);
  }
  return {.region = region,
          .seed = seed,
          .area_m2 = field.length_m * field.width_m,
          .report = name_of(region),
          .summary = ledger.summary,
          .pace = pace.pace(),
          .map_svg = map_svg(ledger, record)};
}

void add(TrialRow& row, const TrialStretch& stretch) {
  const ledger::Summary& summary = stretch.summary;
  row.weeds_total += summary.weeds_total;
  row.accurate += summary.treated_accurate;
  row.partial += summary.treated_partial;
  row.missed += summary.missed;
  for (std::size_t i = 0; i < ledger::kReasonCount; ++i) {
    (ledger::is_vision_loss(static_cast<ledger::Reason>(i)) ? row.missed_vision
                                                            : row.missed_planning) +=
        summary.missed_by_reason[i];
  }
  row.crops_total += summary.crops_total;
  row.crops_hit += summary.crops_hit;
  row.loss_pct = row.weeds_total > 0 ? 100.0 * static_cast<double>(row.missed) /
                                           static_cast<double>(row.weeds_total)
                                     : 0.0;
  row.way_m += stretch.pace.way_m;
  row.time_s += stretch.pace.time_s;
  row.area_m2 += stretch.area_m2;
}

}  // namespace

std::vector<std::string> all_settings(const TrialExperiment& experiment) {
  std::vector<std::string> all = experiment.conditions;
  if (experiment.governed) {
    all.insert(all.end(), experiment.governing.begin(), experiment.governing.end());
  }
  all.insert(all.end(), experiment.settings.begin(), experiment.settings.end());
  return all;
}

double mean_speed_mps(double way_m, double time_s) {
  return time_s > 0.0 ? way_m / time_s : 0.0;
}

double area_rate_ha_per_h(double area_m2, double time_s) {
  constexpr double kHectares = 1e-4;
  constexpr double kHour_s = 3600.0;
  return time_s > 0.0 ? area_m2 * kHectares * kHour_s / time_s : 0.0;
}

TrialResult run(const TrialExperiment& experiment, const std::function<void(double)>& progress) {
  TrialResult result;
  // 98 of 473, 175 of 565, and both: the paper's third table.
  TrialRow weed_only{.region = "weed_only", .paper_loss_pct = 100.0 * 98.0 / 473.0};
  TrialRow crop_weed{.region = "crop_weed", .paper_loss_pct = 100.0 * 175.0 / 565.0};
  TrialRow all{.region = "all", .paper_loss_pct = 100.0 * 273.0 / 1038.0};
  const auto parts = static_cast<double>(experiment.regions.size());
  for (std::size_t i = 0; i < experiment.regions.size(); ++i) {
    const auto done = static_cast<double>(i);
    // The same seed would give all regions the same places of weeds and the same errors of sensors.
    const std::uint64_t seed = experiment.seed * experiment.regions.size() + i;
    result.stretches.push_back(
        run_stretch(experiment, experiment.regions[i], seed,
                    [&](double share) { progress((done + share) / parts); }));
    const TrialStretch& stretch = result.stretches.back();
    add(stretch.region.crop ? crop_weed : weed_only, stretch);
    add(all, stretch);
  }
  result.rows = {weed_only, crop_weed, all};
  return result;
}

}  // namespace furrow::evaluation
