#include "furrow_simulation/appearance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "furrow_core/random.hpp"

namespace furrow::simulation {

void RendererParameters::visit(ParameterVisitor& v) {
  ground.visit(v);
  plants.visit(v);
  light.visit(v);
  camera.visit(v);
  v.visit({.name = "threads",
           .description = "that share the work of a frame; changes the time, not the bytes",
           .min = 1.0,
           .max = 16.0},
          threads);
}

namespace {

void add_variety(std::uint64_t seed, double variety, RendererParameters& p) {
  Random random(seed, "appearance variety");
  p.plants.form_variation = variety * random.uniform(0.3, 1.0);
  if (random.bernoulli(0.35 * variety)) {  // hard sun
    p.light.diffuse_share = random.uniform(0.05, 0.2);
    p.light.sun_elevation_rad = random.uniform(0.3, 1.0);
    p.light.contrast = random.uniform(1.0, 1.5);
    p.light.exposure = random.uniform(0.8, 1.6);
  } else if (random.bernoulli(0.15 * variety)) {  // lamps around the camera
    p.light.sun_elevation_rad = 1.5;
    p.light.diffuse_share = random.uniform(0.5, 1.0);
    p.light.exposure = random.uniform(0.1, 0.35);
    p.light.contrast = random.uniform(0.6, 1.1);
    p.light.saturation = random.uniform(0.4, 1.0);
    p.camera.vignetting = random.uniform(0.3, 0.8);
  } else if (random.bernoulli(0.2 * variety)) {  // pale soil near white
    p.light.exposure = random.uniform(1.5, 2.8);
    p.light.saturation = random.uniform(0.5, 1.1);
  }
  if (random.bernoulli(0.4 * variety)) p.ground.stone_cover = random.uniform(0.01, 0.15);
  if (random.bernoulli(0.25 * variety)) p.ground.straw_per_m2 = random.uniform(50.0, 300.0);
}

}  // namespace

RendererParameters random_appearance(std::uint64_t seed, double variety) {
  RendererParameters p;
  Random ground(seed, "appearance ground");
  // From pale loess over brown and red loams to dark peat.
  constexpr double kSoils[][3] = {{0.56, 0.46, 0.37}, {0.66, 0.57, 0.46}, {0.48, 0.36, 0.27},
                                  {0.58, 0.40, 0.29}, {0.42, 0.36, 0.31}, {0.36, 0.30, 0.26},
                                  {0.60, 0.55, 0.49}, {0.52, 0.48, 0.43}};
  const auto& base = kSoils[ground.integer(0, std::size(kSoils) - 1)];
  const auto& other = kSoils[ground.integer(0, std::size(kSoils) - 1)];
  const double blend = ground.uniform(0.0, 0.5);
  const double lightness = std::exp(ground.normal(0.0, 0.10));
  for (std::size_t i = 0; i < 3; ++i) {
    const double mixed = base[i] + blend * (other[i] - base[i]);
    p.ground.soil_rgb[i] = std::clamp(lightness * mixed + ground.normal(0.0, 0.010), 0.08, 0.9);
  }
  p.ground.moisture = std::pow(ground.uniform(), 1.6);
  p.ground.moisture_patchiness = ground.uniform();
  p.ground.color_variation = ground.uniform();
  p.ground.undulation_mm = ground.uniform(1.0, 14.0);
  p.ground.roughness_mm = ground.uniform(0.1, 1.0);
  p.ground.crumb_cover = ground.uniform(0.05, 0.8);
  p.ground.clod_cover = ground.bernoulli(0.7) ? ground.uniform(0.0, 0.3) : 0.0;
  p.ground.clod_size_mm = ground.uniform(14.0, 60.0);
  p.ground.stone_cover = ground.bernoulli(0.5) ? ground.exponential(0.02) : 0.0;
  p.ground.stone_cover = std::min(p.ground.stone_cover, 0.2);
  p.ground.straw_per_m2 = ground.bernoulli(0.6) ? ground.exponential(30.0) : 0.0;
  p.ground.straw_per_m2 = std::min(p.ground.straw_per_m2, 300.0);
  if (ground.bernoulli(0.25)) {
    p.ground.crack_depth_mm = ground.uniform(1.0, 8.0);
    p.ground.crumb_cover *= 0.4;
    p.ground.clod_cover *= 0.3;
  }

  Random plants(seed, "appearance plants");
  p.plants.leaf_hue = std::clamp(plants.normal(0.0, 0.35), -1.0, 1.0);
  p.plants.leaf_brightness = plants.uniform(0.7, 1.35);
  p.plants.leaf_variation = plants.uniform(0.2, 1.4);
  p.plants.leaf_gloss = plants.uniform();
  p.plants.leaf_curl = plants.uniform();
  p.plants.leaf_damage = std::pow(plants.uniform(), 2.0);
  p.plants.plant_height_scale = plants.uniform(0.5, 1.5);

  Random light(seed, "appearance light");
  p.light.sun_elevation_rad = light.uniform(0.35, 1.25);
  p.light.sun_azimuth_rad = light.uniform(-std::numbers::pi, std::numbers::pi);
  p.light.diffuse_share =
      light.bernoulli(0.35) ? light.uniform(0.75, 1.0) : light.uniform(0.15, 0.6);
  p.light.exposure = std::exp(light.normal(0.0, 0.3));
  p.light.exposure = std::clamp(p.light.exposure, 0.45, 2.0);
  p.light.warmth = light.uniform(-0.6, 0.8);
  p.light.contrast = light.uniform(0.75, 1.3);
  p.light.saturation = light.uniform(0.6, 1.3);
  p.light.robot_shadow = light.bernoulli(0.25);
  p.light.robot_shadow_edge_m = light.uniform(-0.4, 0.5);
  p.light.robot_shadow_angle_rad = light.uniform(-std::numbers::pi, std::numbers::pi);

  Random camera(seed, "appearance camera");
  p.camera.lens_blur_px = camera.uniform(0.3, 1.2);
  p.camera.motion_blur_px = camera.bernoulli(0.5) ? camera.uniform(0.0, 5.0) : 0.0;
  p.camera.vignetting = camera.uniform(0.0, 0.4);
  p.camera.image_noise = camera.uniform(0.3, 5.0);
  p.camera.depth_noise_m = camera.uniform(0.0, 0.004);
  p.camera.depth_hole_share = camera.uniform(0.0, 0.03);
  if (variety > 0.0) add_variety(seed, variety, p);
  return p;
}

}  // namespace furrow::simulation
