// Loss and replanning times of a planner over a stream of observations: a frame every 0.1 s at
// 0.5 m/s, 1 m of look-ahead. Printed beside it: the optimum of sprays on stems with the whole
// field known. With `bound`: the loss below which no placement of footprints can go.
// Usage: stream_loss PLANNER ASSIGNMENT [VIEW [SEEDS [LENGTH_M [KINEMATICS [bound]]]]]
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>

#include "furrow_planning/route_planner.hpp"
#include "furrow_planning/upper_bound.hpp"
#include "stream.hpp"

namespace furrow::planning::bench {
namespace {

struct Outcome {
  double loss_pct = 0.0;
  double travel_m = 0.0;
};

Outcome drive(const PlannerParameters& parameters, const std::vector<Target>& field,
              double length_m, std::vector<double>& times_us) {
  constexpr double kFrame_s = 0.1;
  constexpr double kLookAhead_m = 1.0;
  constexpr double kFront_m = 0.18;
  const auto view = make_observation_view(parameters, four_axes());
  std::size_t next = 0;
  std::vector<TargetOutcome> outcomes;
  for (double x = -kLookAhead_m - kFront_m; x < length_m + 1.0;
       x += kFrame_s * parameters.speed_mps) {
    const double seen = x + kFront_m + kLookAhead_m;
    if (!view->advance({.x_m = x, .speed_mps = parameters.speed_mps}, seen)) {
      std::abort();
    }
    for (; next < field.size() && field[next].p_F.x() < seen; ++next) {
      if (!view->update(field[next])) {
        std::abort();
      }
    }
    const auto begin = std::chrono::steady_clock::now();
    const auto replanned = view->replan();
    const auto end = std::chrono::steady_clock::now();
    if (!replanned) {
      std::fprintf(stderr, "%s\n", replanned.error().message.c_str());
      std::exit(1);
    }
    if (*replanned) {
      times_us.push_back(std::chrono::duration<double, std::micro>(end - begin).count());
    }
  }
  view->take_outcomes(outcomes);
  Outcome result;
  std::size_t treated = 0;
  for (const TargetOutcome& outcome : outcomes) {
    treated += outcome.decision == Decision::kTreat ? 1U : 0U;
  }
  if (outcomes.size() != field.size()) {
    std::fprintf(stderr, "%zu outcomes for %zu targets\n", outcomes.size(), field.size());
    std::exit(1);
  }
  result.loss_pct =
      100.0 * (1.0 - static_cast<double>(treated) / static_cast<double>(field.size()));
  for (const double travel : view->travel_m()) {
    result.travel_m += travel / 4.0;
  }
  return result;
}

/// Loss in % with the whole field known; by a planner, or by the bound on all footprints.
double clairvoyant_loss_pct(bool bound, PlannerParameters parameters,
                            const std::vector<Target>& field) {
  parameters.planner = "exact";
  parameters.assignment = "joint";
  const auto axes = four_axes();
  std::vector<AxisState> states;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    states.push_back({.position_m = 1.39 * (static_cast<double>(a) + 0.5) / 4.0 - 0.695,
                      .free_from_x_m = -1.18});
  }
  const PlanningProblem problem{.targets = field,
                                .protected_plants = {},
                                .axes = axes,
                                .states = states,
                                .robot = {.x_m = -1.18}};
  double weight = NAN;
  if (bound) {
    const auto limit = footprint_weight_bound(problem, parameters, {.iterations = 60});
    weight = limit ? *limit : NAN;
  } else if (Plan plan; make_route_planner(parameters)->plan(problem, plan)) {
    weight = plan.weight;
  }
  return 100.0 * (1.0 - weight / static_cast<double>(field.size()));
}

int run(int argc, char** argv) {
  PlannerParameters parameters;
  parameters.planner = argc > 1 ? argv[1] : "exact";
  parameters.assignment = argc > 2 ? argv[2] : "joint";
  parameters.view = argc > 3 ? argv[3] : "rolling";
  const int seeds = argc > 4 ? std::atoi(argv[4]) : 20;
  const double length_m = argc > 5 ? std::atof(argv[5]) : 20.0;
  parameters.kinematics = argc > 6 ? argv[6] : "velocity";
  const bool with_bound = argc > 7;
  std::printf("%s %s %s %s, %d seeds of %.0f m\n", parameters.planner.c_str(),
              parameters.assignment.c_str(), parameters.view.c_str(), parameters.kinematics.c_str(),
              seeds, length_m);
  std::printf("per m2   loss %%   optimum %%  travel m   replan us: p50    p99    max\n");
  for (const double density : {3.1, 8.2, 15.4, 22.3, 81.2}) {
    std::vector<double> times_us;
    double loss = 0.0;
    double optimum = 0.0;
    double limit = 0.0;
    double travel = 0.0;
    for (int seed = 0; seed < seeds; ++seed) {
      const auto field = poisson_field(density, length_m, 1.39, static_cast<std::uint64_t>(seed));
      const Outcome outcome = drive(parameters, field, length_m, times_us);
      loss += outcome.loss_pct / seeds;
      travel += outcome.travel_m / seeds;
      optimum += clairvoyant_loss_pct(false, parameters, field) / seeds;
      limit += with_bound ? clairvoyant_loss_pct(true, parameters, field) / seeds : 0.0;
    }
    std::sort(times_us.begin(), times_us.end());
    std::printf("%6.1f   %6.2f   %6.2f     %6.1f   %14.1f %6.1f %6.1f\n", density, loss, optimum,
                travel, times_us[times_us.size() / 2], times_us[times_us.size() * 99 / 100],
                times_us.back());
    if (with_bound) {
      std::printf("         at least %.2f with footprints placed anywhere\n", limit);
    }
  }
  return 0;
}

}  // namespace
}  // namespace furrow::planning::bench

int main(int argc, char** argv) {
  return furrow::planning::bench::run(argc, argv);
}
