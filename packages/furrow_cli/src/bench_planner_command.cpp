#include <iostream>
#include <memory>
#include <stdexcept>

#include "allocation_count.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "experiment_options.hpp"
#include "furrow_core/version.hpp"
#include "furrow_experiments/planner_benchmark.hpp"

namespace furrow::cli {
namespace {

int bench_planner(const ExperimentOptions& options) {
  ResultFiles files(options.results);
  experiments::PlannerBenchmark benchmark;
  benchmark.fields = chosen_fields(options);
  benchmark.planners = chosen_planners(options);
  benchmark.planner = options.planner;
  benchmark.setup = options.setup;
  benchmark.sampling = options.sampling;
  benchmark.allocations = thread_allocations;
  ProgressBar bar("planner");
  const auto result = run(benchmark, [&bar](double share) { bar.show(share, ""); });
  bar.finish();
  if (!result.ok()) throw std::runtime_error(result.error().message);
  std::cout << to_text(*result);
  files.write_json(to_json(benchmark, *result, version()));
  if (files.wants_html()) files.write_html(to_html(benchmark, *result, version()));
  return 0;
}

}  // namespace

void add_bench_planner_command(Command root) {
  auto options = std::make_shared<ExperimentOptions>();
  options->sampling.seeds = 3;
  Command command = bench_group(root).subcommand("planner", "Time to plan, on one thread.");
  add_experiment_options(command, *options);
  command.on_run([options, command] {
    apply_quick(command, *options);
    return bench_planner(*options);
  });
}

}  // namespace furrow::cli
