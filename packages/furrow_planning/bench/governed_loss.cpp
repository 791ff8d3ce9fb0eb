// Loss and mean speed of a robot at constant speeds, and of one that follows the speed governor,
// over fields of several densities. Axes have real dwell and settle times. Each image at 3 Hz
// triggers a plan; look-ahead 1.3 m; detection is perfect.
// Usage: governed_loss [SEEDS [LENGTH_M]]
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "furrow_planning/kinematics.hpp"
#include "furrow_planning/speed_governor.hpp"
#include "stream.hpp"

namespace furrow::planning::bench {
namespace {

constexpr double kRow_mps = 0.5;
constexpr double kStep_s = 0.02;
constexpr int kStepsPerImage = 17;
constexpr double kLookAhead_m = 1.3;
constexpr double kFront_m = 0.18;

struct Sum {
  double targets = 0.0;
  double lost = 0.0;
  double way_m = 0.0;
  double time_s = 0.0;
  double trials = 0.0;
  double images = 0.0;
};

/// params/components/planner.yaml.
PlannerParameters shipped(double speed_mps) {
  PlannerParameters parameters;
  parameters.kinematics = "trapezoid";
  parameters.speed_mps = speed_mps;
  parameters.dwell_s = 0.010;
  parameters.settle_s = 0.025;
  parameters.rho = 0.5;
  parameters.commit_s = 0.3;
  parameters.placement_margin_m = 0.005;
  parameters.centre_preference = 0.4;
  return parameters;
}

/// Sprays that axes had the time for; a driver gives up what is 10 ms late.
class Axes {
 public:
  explicit Axes(const PlannerParameters& parameters) : rule_(parameters, kRow_mps, AxisSpec{}) {}

  int take(const ObservationView& view, double from_m, double to_m, double time_s) {
    int treated = 0;
    for (std::size_t a = 0; a < last_.size(); ++a) {
      for (const Stop& stop : view.plan().routes[a]) {
        if (stop.robot_x_m <= from_m || stop.robot_x_m > to_m) continue;
        const double at_s = time_s + kStep_s * (stop.robot_x_m - from_m) / (to_m - from_m);
        const double needed_s =
            rule_.margin_s() + rule_.move_s(stop.position_m - last_[a].position_m);
        if (at_s - last_[a].time_s < needed_s - 0.010) continue;
        last_[a] = {at_s, stop.position_m};
        treated += static_cast<int>(stop.target_count);
      }
    }
    return treated;
  }

 private:
  struct Made {
    double time_s = -10.0;
    double position_m = 0.0;
  };
  Transition rule_;
  std::vector<Made> last_ = std::vector<Made>(4);
};

void require(const Status& status) {
  if (!status.ok()) throw std::runtime_error(status.error().message);
}

void drive(bool governed, double speed_mps, const std::vector<Target>& field, double length_m,
           Sum& sum) {
  const PlannerParameters parameters = shipped(speed_mps);
  const auto view = make_observation_view(parameters, four_axes());
  SpeedGovernor governor({}, kRow_mps, kFront_m, -kFront_m);
  Axes axes(parameters);
  std::size_t next = 0;
  int treated = 0;
  double x_m = -kLookAhead_m - kFront_m;
  double v_mps = speed_mps;
  for (int step = 0; x_m < length_m + 0.5; ++step) {
    if (step % kStepsPerImage == 0) {
      const double seen_m = x_m + kFront_m + kLookAhead_m;
      require(view->advance({.x_m = x_m, .speed_mps = v_mps}, seen_m));
      for (; next < field.size() && field[next].p_F.x() < seen_m; ++next) {
        require(view->update(field[next]));
      }
      if (governed) {
        require(governor.consider(
            {x_m, v_mps, view->committed_until_x_m(), std::ssize(view->plan().decisions)},
            [&](const SpeedProfile& speeds) {
              sum.trials += 1.0;
              return view->left_at(speeds);
            }));
        require(view->set_speeds(governor.expected()));
      }
      if (const auto replanned = view->replan(); !replanned.ok()) {
        throw std::runtime_error(replanned.error().message);
      }
      sum.images += 1.0;
    }
    v_mps = governed ? governor.request_mps(x_m) : speed_mps;
    const double to_m = x_m + v_mps * kStep_s;
    treated += axes.take(*view, x_m, to_m, step * kStep_s);
    if (x_m >= 0.0 && to_m <= length_m) {
      sum.way_m += to_m - x_m;
      sum.time_s += kStep_s;
    }
    x_m = to_m;
  }
  sum.targets += static_cast<double>(field.size());
  sum.lost += static_cast<double>(field.size()) - treated;
}

int run(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 10;
  const double length_m = argc > 2 ? std::atof(argv[2]) : 12.0;
  std::printf(
      "per m2   at constant m/s: loss %%          governed: loss %%   m/s   plans an image\n");
  std::printf("             0.5     0.4     0.3\n");
  for (const double density : {3.1, 8.2, 15.4, 22.3, 30.0, 81.2}) {
    std::printf("%6.1f  ", density);
    for (const double speed_mps : {0.5, 0.4, 0.3, 0.0}) {
      const bool governed = speed_mps <= 0.0;
      Sum sum;
      for (int seed = 0; seed < seeds; ++seed) {
        const auto field =
            poisson_field(density, length_m, 1.39, 1000 + static_cast<std::uint64_t>(seed));
        drive(governed, governed ? kRow_mps : speed_mps, field, length_m, sum);
      }
      std::printf("%8.2f", 100.0 * sum.lost / sum.targets);
      if (governed) {
        std::printf("  %16.3f  %8.1f\n", sum.way_m / sum.time_s, sum.trials / sum.images);
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace furrow::planning::bench

int main(int argc, char** argv) {
  try {
    return furrow::planning::bench::run(argc, argv);
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    return 1;
  }
}
