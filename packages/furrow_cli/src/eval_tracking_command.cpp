#include <iostream>
#include <memory>
#include <stdexcept>

#include "command.hpp"
#include "console.hpp"
#include "furrow_components/track_field.hpp"
#include "furrow_core/file.hpp"
#include "furrow_graph/parameter_file.hpp"
#include "share.hpp"
#include "tracking_experiment.hpp"
#include "verb.hpp"

namespace furrow::cli {
namespace {

struct TrackingOptions {
  TrackingExperiment experiment;
  bool quick = false;
  std::string json;
  std::string html;
};

/// What stands in the parameter files of the shipped components.
struct TrackerFile {
  components::ObservationParameters observation;
  components::TrackFieldParameters field;
  tracking::TrackerParameters tracker;
  void visit(ParameterVisitor& v) {
    observation.visit(v);
    field.visit(v);
    tracker.visit(v);
  }
};
struct LocalizationFile {
  std::string estimator;
  localization::PoseFilterParameters filter;
  components::GeoreferenceParameters georeference;
  void visit(ParameterVisitor& v) {
    v.visit({.name = "estimator", .description = "odometry or filter"}, estimator);
    PrefixedVisitor filter_visitor(v, "filter_");
    filter.visit(filter_visitor);
    georeference.visit(v);
  }
};

void load_shipped(ReplayOptions& replay) {
  const auto tracker =
      graph::load_parameter_file<TrackerFile>(find_shipped("tracker", "components"));
  replay.observation = tracker.observation;
  replay.tracker = tracker.tracker;
  const auto localization =
      graph::load_parameter_file<LocalizationFile>(find_shipped("localization_rtk", "components"));
  replay.filter = localization.filter;
  replay.georeference = localization.georeference;
}

void print(const std::vector<TrackingRow>& rows) {
  std::vector<std::vector<std::string>> table = {
      {"field", "association", "localization", "NAE crop %", "NAE weed %", "of all: crop %",
       "weed %", "MOTA", "IDF1", "HOTA", "switches", "stem p95 mm", "pose rms mm"}};
  for (const TrackingRow& row : rows) {
    table.push_back({row.field, row.association, row.localization, number(row.nae_crop_pct, 1),
                     number(row.nae_weed_pct, 1), number(row.nae_crop_all_pct, 1),
                     number(row.nae_weed_all_pct, 1), number(row.mota, 3), number(row.idf1, 3),
                     number(row.hota, 3), std::to_string(row.id_switches),
                     number(row.stem_p95_mm, 1), number(row.pose_rms_mm, 1)});
  }
  std::cout << text_table(table);
}

void write_result(const std::string& file, const std::string& text) {
  if (file.empty()) return;
  if (const Status written = write_file_atomically(file, text); !written.ok()) {
    throw std::runtime_error(written.error().message);
  }
  std::cout << file << '\n';
}

void evaluate(const TrackingOptions& options) {
  TrackingExperiment experiment = options.experiment;
  load_shipped(experiment.replay);
  ProgressBar bar("tracking");
  const auto rows = run(experiment, [&bar](double share) { bar.show(share, ""); });
  bar.finish();
  print(rows);
  write_result(options.json, to_json(experiment, rows, FURROW_VERSION));
  write_result(options.html, to_html(experiment, rows, FURROW_VERSION));
}

}  // namespace

void add_eval_tracking_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command =
      group(app, "eval", "The experiments, the paper's figures beside ours.")
          ->add_subcommand("tracking",
                           "Counts, identities and positions of plants by association and "
                           "localization, on rendered rows.");
  auto options = std::make_shared<TrackingOptions>();
  TrackingExperiment& experiment = options->experiment;
  command->add_option("--field", experiment.fields, "shipped presets, or fields as files")
      ->capture_default_str();
  command->add_option("--seeds", experiment.seeds, "generated fields of each preset")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->add_option("--seed", experiment.first_seed, "of the first field")->capture_default_str();
  command->add_option("--length", experiment.length_m, "of each row, m")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  command
      ->add_option("--set", experiment.settings,
                   "COMPONENT.KEY=VALUE of robot, camera or perception")
      ->take_all();
  command->add_option("--threads", experiment.threads, "that call components")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_flag("--quick", options->quick, "three fields of 4 m");
  command->add_option("--json", options->json, "file of the results");
  command->add_option("--html", options->html, "file of the report");
  command->callback([options, command] {
    if (options->quick) {
      if (command->count("--field") == 0) {
        options->experiment.fields = {"cn20_like", "sb20_s1_like", "sb21_s1_like"};
      }
      if (command->count("--length") == 0) options->experiment.length_m = 4.0;
    }
    evaluate(*options);
  });
}

}  // namespace furrow::cli
