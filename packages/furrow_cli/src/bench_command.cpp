#include <iostream>
#include <memory>
#include <stdexcept>

#include "allocation_count.hpp"
#include "command.hpp"
#include "console.hpp"
#include "experiment_options.hpp"
#include "furrow_experiments/planner_benchmark.hpp"
#include "verb.hpp"

namespace furrow::cli {
namespace {

void print_rows(const std::vector<experiments::BenchmarkRow>& rows) {
  std::vector<std::vector<std::string>> table = {
      {"planner", "per m2", "targets", "p50 us", "p99 us", "plans", "allocations"}};
  for (const auto& row : rows) {
    table.push_back({row.planner, number(row.weeds_per_m2, 1), number(row.targets, 0),
                     number(row.replan_p50_us, 1), number(row.replan_p99_us, 1),
                     std::to_string(row.replans),
                     row.allocations_per_replan ? number(*row.allocations_per_replan, 2) : "-"});
  }
  std::cout << text_table(table);
}

void bench_planner(const ExperimentOptions& options) {
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
  std::cout << "replanning at each frame\n";
  print_rows(result->stream);
  std::cout << "\none plan of a window of that many targets\n";
  print_rows(result->window);
  write_results(options, to_json(benchmark, *result, FURROW_VERSION),
                to_html(benchmark, *result, FURROW_VERSION));
}

}  // namespace

void add_bench_command(CLI::App& app, int& /*exit_code*/) {
  CLI::App* command = group(app, "bench", "Speeds, with the alternative measured beside.");
  auto options = std::make_shared<ExperimentOptions>();
  options->sampling.seeds = 3;
  CLI::App* planner = command->add_subcommand("planner", "Time to plan, on one thread.");
  add_experiment_options(planner, *options);
  planner->callback([options] { bench_planner(*options); });
}

}  // namespace furrow::cli
