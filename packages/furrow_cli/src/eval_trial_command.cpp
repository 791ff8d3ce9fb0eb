#include <iostream>
#include <memory>
#include <stdexcept>

#include "command.hpp"
#include "console.hpp"
#include "furrow_core/file.hpp"
#include "trial_experiment.hpp"
#include "verb.hpp"

namespace furrow::cli {
namespace {

struct TrialOptions {
  TrialExperiment experiment;
  std::string out = "out/trial";
  bool quick = false;
  bool constant_speed = false;
  std::string json;
  std::string html;
};

std::string share(std::int64_t part, std::int64_t whole) {
  return whole == 0 ? "-"
                    : number(100.0 * static_cast<double>(part) / static_cast<double>(whole), 1);
}

void print(const TrialResult& result) {
  std::vector<std::vector<std::string>> table = {{"region", "weeds", "accurate", "partial",
                                                  "missed", "vision", "planning", "loss %",
                                                  "paper %", "crops", "hit %", "m/s", "ha/h"}};
  for (const TrialRow& row : result.rows) {
    table.push_back({row.region, std::to_string(row.weeds_total), std::to_string(row.accurate),
                     std::to_string(row.partial), std::to_string(row.missed),
                     std::to_string(row.missed_vision), std::to_string(row.missed_planning),
                     number(row.loss_pct, 1), number(row.paper_loss_pct, 1),
                     std::to_string(row.crops_total), share(row.crops_hit, row.crops_total),
                     number(mean_speed_mps(row.way_m, row.time_s), 2),
                     number(area_rate_ha_per_h(row.area_m2, row.time_s), 2)});
  }
  std::cout << text_table(table);
}

void write_result(const std::filesystem::path& file, const std::string& text) {
  if (file.empty()) return;
  if (const Status written = write_file_atomically(file, text); !written.ok()) {
    throw std::runtime_error(written.error().message);
  }
  std::cout << file.string() << '\n';
}

void evaluate(const TrialOptions& options) {
  TrialExperiment experiment = options.experiment;
  experiment.folder = options.out;
  experiment.governed = !options.constant_speed;
  ProgressBar bar("trial");
  const TrialResult result = run(experiment, [&bar](double done) { bar.show(done, ""); });
  bar.finish();
  print(result);
  write_result(options.json, to_json(experiment, result, FURROW_VERSION));
  write_result(
      options.html.empty() ? experiment.folder / "trial.html" : std::filesystem::path(options.html),
      to_html(experiment, result, FURROW_VERSION));
}

}  // namespace

void add_eval_trial_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command = group(app, "eval", "The experiments, the paper's figures beside ours.")
                          ->add_subcommand("trial",
                                           "The paper's field trial, closed loop: weed-only and "
                                           "crop-weed regions from low to high density.");
  auto options = std::make_shared<TrialOptions>();
  TrialExperiment& experiment = options->experiment;
  command->add_option("--graph", experiment.graph, "graph file, or the name of a shipped one")
      ->capture_default_str();
  command->add_option("--length", experiment.length_m, "of each of the six stretches, m")
      ->check(CLI::Range(1.0, 1000.0))
      ->capture_default_str();
  command->add_option("--seed", experiment.seed, "of everything that is random")
      ->capture_default_str();
  command->add_option("--set", experiment.settings, "COMPONENT.KEY=VALUE over the files")
      ->take_all();
  command->add_option("--threads", experiment.threads, "that call components")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  command->add_flag("--constant-speed", options->constant_speed,
                    "the robot keeps its speed; else it drives as slowly as the planner asks");
  command->add_flag("--quick", options->quick, "stretches of 3 m");
  command->add_option("--out", options->out, "folder of the fields and reports")
      ->capture_default_str();
  command->add_option("--json", options->json, "file of the results");
  command->add_option("--html", options->html, "file of the report; default: trial.html in --out");
  command->callback([options, command] {
    constexpr double kQuick_m = 3.0;
    if (options->quick && command->count("--length") == 0) options->experiment.length_m = kQuick_m;
    evaluate(*options);
  });
}

}  // namespace furrow::cli
