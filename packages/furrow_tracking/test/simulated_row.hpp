#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "furrow_core/random.hpp"
#include "furrow_tracking/metrics.hpp"
#include "furrow_tracking/tracker.hpp"

namespace furrow::tracking::test {

struct Plant {
  std::int64_t id = 0;
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();
  double radius_m = 0.01;
  PlantClass plant_class = PlantClass::kWeed;
};

struct RowOptions {
  double length_m = 6.0;
  double weeds_per_m2 = 22.3;
  double least_distance_m = 0.02;  ///< between stems
  double stem_sigma_m = 0.002;
  double detection_probability = 0.97;
  double wrong_class_probability = 0.05;
  double ghosts_per_view = 0.0;
  double pose_sigma_m = 0.0;  ///< of each view's pose, drawn anew
  double speed_mps = 0.5;
  double view_hz = 5.0;
};

/// A stretch of field 1.4 m wide with crops along y = 0 and weeds anywhere, and what a camera that
/// passes over it reports. Simulated.
class Row {
 public:
  Row(std::uint64_t seed, const RowOptions& options) : seed_(seed), options_(options) {
    Random random(seed, "plants");
    for (double x_m = 0.1; x_m < options.length_m; x_m += 0.2) {
      place({x_m, random.normal(0.0, 0.01)}, random.uniform(0.03, 0.06), PlantClass::kCrop);
    }
    const std::int64_t weeds = random.poisson(options.weeds_per_m2 * options.length_m * 1.4);
    for (std::int64_t i = 0; i < weeds; ++i) {
      const double x_m = random.uniform(0.0, options.length_m);
      const double y_m = random.uniform(-0.7, 0.7);
      place({x_m, y_m}, random.uniform(0.005, 0.025), PlantClass::kWeed);
    }
  }

  [[nodiscard]] const std::vector<Plant>& plants() const { return plants_; }
  [[nodiscard]] int views() const {
    return static_cast<int>((options_.length_m + 2.0) / options_.speed_mps * options_.view_hz);
  }

  /// The view with the robot `driven_m` along the row, at a time counted in views.
  [[nodiscard]] View view(int index, double driven_m) const {
    View view;
    view.stamp = Time::from_seconds(1.0 + index / options_.view_hz);
    view.X_FB = {driven_m - 2.0, 0.0, 0.0};
    const double variance = options_.pose_sigma_m * options_.pose_sigma_m;
    view.pose_covariance.diagonal() << variance, variance, 0.0;
    view.visible =
        *GroundRegion::from_bounds({view.X_FB.x_m + 0.65, -0.735}, {view.X_FB.x_m + 1.75, 0.735});
    return view;
  }
  [[nodiscard]] View view(int index) const {
    return view(index, index * options_.speed_mps / options_.view_hz);
  }

  [[nodiscard]] std::vector<Observation> observe(const View& view) const {
    Random random(seed_, "view", static_cast<std::uint64_t>(view.stamp.count_ns()));
    const Eigen::Vector2d shift(random.normal(0.0, options_.pose_sigma_m),
                                random.normal(0.0, options_.pose_sigma_m));
    std::vector<Observation> observations;
    for (const Plant& plant : plants_) {
      const Eigen::Vector2d noise(random.normal(0.0, options_.stem_sigma_m),
                                  random.normal(0.0, options_.stem_sigma_m));
      const bool detected = random.bernoulli(options_.detection_probability);
      const bool wrong = random.bernoulli(options_.wrong_class_probability);
      if (!detected || !view.visible.contains(plant.p_F_m)) continue;
      Observation& seen = observations.emplace_back();
      seen.p_F_m = plant.p_F_m + noise + shift;
      seen.covariance_F_m2 = Eigen::Matrix2d::Identity() * std::pow(options_.stem_sigma_m, 2);
      seen.radius_m = plant.radius_m * random.uniform(0.9, 1.1);
      seen.area_mm2 = 2e6 * plant.radius_m * plant.radius_m;
      seen.score = random.uniform(0.7, 1.0);
      const bool crop = (plant.plant_class == PlantClass::kCrop) != wrong;
      seen.class_probability = crop ? std::array{0.95, 0.05} : std::array{0.05, 0.95};
    }
    const std::int64_t ghosts = random.poisson(options_.ghosts_per_view);
    for (std::int64_t i = 0; i < ghosts; ++i) {
      Observation& seen = observations.emplace_back();
      seen.p_F_m = {view.X_FB.x_m + random.uniform(0.65, 1.75), random.uniform(-0.73, 0.73)};
      seen.radius_m = random.uniform(0.005, 0.02);
      seen.score = 0.8;
      seen.class_probability = {0.2, 0.8};
    }
    return observations;
  }

  [[nodiscard]] std::vector<LabelledPoint> truth_in(const View& view) const {
    std::vector<LabelledPoint> points;
    for (const Plant& plant : plants_) {
      if (view.visible.contains(plant.p_F_m)) points.push_back({plant.id, plant.p_F_m});
    }
    return points;
  }

 private:
  void place(const Eigen::Vector2d& p_F_m, double radius_m, PlantClass plant_class) {
    for (const Plant& other : plants_) {
      if ((other.p_F_m - p_F_m).norm() < options_.least_distance_m) return;
    }
    plants_.push_back(
        {static_cast<std::int64_t>(plants_.size()) + 1, p_F_m, radius_m, plant_class});
  }

  std::uint64_t seed_;
  RowOptions options_;
  std::vector<Plant> plants_;
};

/// Believed tracks in sight, as the metrics take them.
inline std::vector<LabelledPoint> tracked_in(const Tracker& tracker, const View& view) {
  std::vector<LabelledPoint> points;
  for (const Track& track : tracker.tracks()) {
    if (track.confirmed && view.visible.contains(track.p_F_m)) {
      points.push_back({static_cast<std::int64_t>(track.id), track.p_F_m});
    }
  }
  return points;
}

}  // namespace furrow::tracking::test
