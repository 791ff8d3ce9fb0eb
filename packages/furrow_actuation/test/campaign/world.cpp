#include "world.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::actuation::campaign {

World::World(Random& random, Journey journey) : journey_(journey) {
  constexpr int kCrops = 10;
  constexpr int kWeeds = 24;
  for (int i = 0; i < kCrops + kWeeds; ++i) {
    const Eigen::Vector2d p_F(random.uniform(0.6, 4.0), random.uniform(-0.6, 0.6));
    plants_.push_back({i, i < kCrops, p_F});
    if (i >= kCrops && random.bernoulli(0.25)) {  // right beside a crop
      const TruePlant& crop = plants_[static_cast<std::size_t>(random.integer(0, kCrops - 1))];
      plants_.back().p_F =
          crop.p_F + Eigen::Vector2d(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
    }
  }
  base_.twist_B.vx_mps = journey_.speed_mps;
}

double World::commanded_mps(double t_s) const {
  const double into_s = t_s - journey_.pause_at_s;
  if (into_s < 0.0 || into_s >= journey_.pause_s) return journey_.speed_mps;
  return into_s < journey_.back_s ? -Journey::kBack_mps : 0.0;
}

void World::advance() {
  const double h = kCycle.to_seconds();
  const double most = Journey::kAcceleration_mps2 * h;
  const double wanted = commanded_mps(base_.stamp.to_seconds());
  const double before = base_.twist_B.vx_mps;
  base_.twist_B.vx_mps += std::clamp(wanted - before, -most, most);
  base_.X_FB.x_m += 0.5 * (before + base_.twist_B.vx_mps) * h;
  base_.stamp += kCycle;
}

geometry::AxisModel axis_model(int index) {
  geometry::AxisModel axis;
  axis.name = "axis_" + std::to_string(index + 1);
  axis.p_BN0 = {0.18 - 0.12 * index, 0.0, 0.6};
  axis.lower_m = -0.695;
  axis.upper_m = 0.695;
  axis.max_velocity_mps = 5.0;
  axis.max_acceleration_mps2 = 50.0;
  axis.max_jerk_mps3 = 2000.0;
  axis.nozzle.height_m = 0.6;
  axis.nozzle.footprint_radius_m = 0.025;
  return axis;
}

Eigen::Vector2d drop_landing(const BaseState& base, const geometry::AxisModel& axis, double q_m,
                             double q_velocity_mps) {
  // h = u t + g t^2 / 2 with u = 10 m/s, h = 0.6 m, by its positive root.
  constexpr double kGravity_mps2 = 9.80665;
  constexpr double kExit_mps = 10.0;
  const double fall_s =
      (std::sqrt(kExit_mps * kExit_mps + 2.0 * kGravity_mps2 * axis.nozzle.height_m) - kExit_mps) /
      kGravity_mps2;
  const Eigen::Vector2d nozzle_F(base.X_FB.x_m + axis.p_BN0.x(), base.X_FB.y_m + q_m);
  return nozzle_F + fall_s * Eigen::Vector2d(base.twist_B.vx_mps, q_velocity_mps);
}

}  // namespace furrow::actuation::campaign
