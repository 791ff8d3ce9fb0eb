#include <algorithm>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "furrow_core/text.hpp"
#include "furrow_core/version.hpp"
#include "furrow_evaluation/nozzle_calibration.hpp"
#include "output_options.hpp"

namespace furrow::cli {
namespace {

struct CalibrateOptions {
  std::string graph = "weeding";
  std::vector<std::string> settings;
  int sprays = 12;
  int rounds = 2;
  std::uint64_t seed = 1;
  double limit_mm = 4.0;
  std::string measured;
  std::string out = "nozzles.yaml";
  ResultOptions results;
};

int calibrate(const CalibrateOptions& options) {
  ResultFiles files(options.results);
  OutputFile out = claim_file(options.out, options.results.force);
  const launch::PreparedGraph prepared = launch::prepare_graph(options.graph, options.settings);
  const bool by_measurements = !options.measured.empty();
  const evaluation::NozzleCalibrationResult result =
      by_measurements
          ? evaluation::calibrate_by_measurements(prepared, options.measured)
          : evaluation::calibrate_in_simulator(
                prepared, {.sprays = options.sprays, .seed = options.seed}, options.rounds);
  std::cout << to_table(result.rows);
  files.write_json(to_json(result.rows,
                           {.graph = options.graph,
                            .settings = options.settings,
                            .sprays = options.sprays,
                            .rounds = options.rounds,
                            .seed = options.seed},
                           version()));
  // NaN, of a nozzle that left nothing on the ground, counts as off.
  const bool off = !by_measurements && std::ranges::any_of(result.rows, [&](const auto& row) {
    return !(row.after_p95_mm <= options.limit_mm);
  });
  if (off) {
    std::cerr << "furrow: a nozzle still lands more than " << fixed(options.limit_mm, 1)
              << " mm off (p95); nothing was written to " << out.path().string() << '\n';
    return 1;
  }
  write_or_throw(
      out, components::nozzle_file_text(
               result.nozzles, by_measurements
                                   ? "Written by furrow calibrate from measured offsets."
                                   : "Written by furrow calibrate over a simulated test pattern."));
  std::cout << "calibration: " << out.path().string() << '\n';
  return 0;
}

}  // namespace

void add_calibrate_command(Command root) {
  auto options = std::make_shared<CalibrateOptions>();
  Command command = root.subcommand(
      "calibrate",
      "Calibrates the nozzles by a test pattern, sprayed in the simulator or measured on paper.");
  command.option("--graph", options->graph, "graph file, or the name of a shipped graph");
  command.option("--set", options->settings,
                 "COMPONENT.KEY=VALUE overrides a parameter; common.KEY=VALUE for all components");
  command.option("--sprays", options->sprays, "sprays of each nozzle at each of three speeds")
      .range(2, 60);
  command.option("--rounds", options->rounds, "times to fit the nozzles and spray again")
      .range(1, 10);
  command.option("--seed", options->seed, "seed of all random numbers");
  command
      .option("--limit-mm", options->limit_mm,
              "a nozzle that still lands farther off (p95) is an error")
      .range(0.01, 1000.0);
  command.option("--measured", options->measured,
                 "offsets measured on paper (axis,speed_mps,along_mm,across_mm) in place of the "
                 "simulator's");
  command.option("--out", options->out, "calibration file");
  add_result_options(command, options->results, false);
  command.on_run([options] { return calibrate(*options); });
}

}  // namespace furrow::cli
