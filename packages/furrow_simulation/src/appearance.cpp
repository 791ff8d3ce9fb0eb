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
           .description = "threads that share a frame; they change the time, not the bytes",
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

void draw_ground(std::uint64_t seed, GroundParameters& p) {
  Random random(seed, "appearance ground");
  // From pale loess over brown and red loams to dark peat.
  constexpr double kSoils[][3] = {{0.56, 0.46, 0.37}, {0.66, 0.57, 0.46}, {0.48, 0.36, 0.27},
                                  {0.58, 0.40, 0.29}, {0.42, 0.36, 0.31}, {0.36, 0.30, 0.26},
                                  {0.60, 0.55, 0.49}, {0.52, 0.48, 0.43}};
  const auto& base = kSoils[random.integer(0, std::size(kSoils) - 1)];
  const auto& other = kSoils[random.integer(0, std::size(kSoils) - 1)];
  const double blend = random.uniform(0.0, 0.5);
  const double lightness = std::exp(random.normal(0.0, 0.10));
  for (std::size_t i = 0; i < 3; ++i) {
    const double mixed = base[i] + blend * (other[i] - base[i]);
    p.soil_rgb[i] = std::clamp(lightness * mixed + random.normal(0.0, 0.010), 0.08, 0.9);
  }
  p.moisture = std::pow(random.uniform(), 1.6);
  p.moisture_patchiness = random.uniform();
  p.color_variation = random.uniform();
  p.undulation_mm = random.uniform(1.0, 14.0);
  p.roughness_mm = random.uniform(0.1, 1.0);
  p.crumb_cover = random.uniform(0.05, 0.8);
  p.clod_cover = random.bernoulli(0.7) ? random.uniform(0.0, 0.3) : 0.0;
  p.clod_size_mm = random.uniform(14.0, 60.0);
  p.stone_cover = random.bernoulli(0.5) ? random.exponential(0.02) : 0.0;
  p.stone_cover = std::min(p.stone_cover, 0.2);
  p.straw_per_m2 = random.bernoulli(0.6) ? random.exponential(30.0) : 0.0;
  p.straw_per_m2 = std::min(p.straw_per_m2, 300.0);
  if (random.bernoulli(0.25)) {
    p.crack_depth_mm = random.uniform(1.0, 8.0);
    p.crumb_cover *= 0.4;
    p.clod_cover *= 0.3;
  }
}

void draw_plants(std::uint64_t seed, PlantParameters& p) {
  Random random(seed, "appearance plants");
  p.leaf_hue = std::clamp(random.normal(0.0, 0.35), -1.0, 1.0);
  p.leaf_brightness = random.uniform(0.7, 1.35);
  p.leaf_variation = random.uniform(0.2, 1.4);
  p.leaf_gloss = random.uniform();
  p.leaf_curl = random.uniform();
  p.leaf_damage = std::pow(random.uniform(), 2.0);
  p.plant_height_scale = random.uniform(0.5, 1.5);
}

void draw_light(std::uint64_t seed, LightParameters& p) {
  Random random(seed, "appearance light");
  p.sun_elevation_rad = random.uniform(0.35, 1.25);
  p.sun_azimuth_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
  p.diffuse_share = random.bernoulli(0.35) ? random.uniform(0.75, 1.0) : random.uniform(0.15, 0.6);
  p.exposure = std::exp(random.normal(0.0, 0.3));
  p.exposure = std::clamp(p.exposure, 0.45, 2.0);
  p.warmth = random.uniform(-0.6, 0.8);
  p.contrast = random.uniform(0.75, 1.3);
  p.saturation = random.uniform(0.6, 1.3);
  p.robot_shadow = random.bernoulli(0.25);
  p.robot_shadow_edge_m = random.uniform(-0.4, 0.5);
  p.robot_shadow_angle_rad = random.uniform(-std::numbers::pi, std::numbers::pi);
}

void draw_camera(std::uint64_t seed, CameraEffectParameters& p) {
  Random random(seed, "appearance camera");
  p.lens_blur_px = random.uniform(0.3, 1.2);
  p.motion_blur_px = random.bernoulli(0.5) ? random.uniform(0.0, 5.0) : 0.0;
  p.vignetting = random.uniform(0.0, 0.4);
  p.image_noise = random.uniform(0.3, 5.0);
  p.depth_noise_m = random.uniform(0.0, 0.004);
  p.depth_hole_share = random.uniform(0.0, 0.03);
}

}  // namespace

RendererParameters random_appearance(std::uint64_t seed, double variety) {
  RendererParameters p;
  draw_ground(seed, p.ground);
  draw_plants(seed, p.plants);
  draw_light(seed, p.light);
  draw_camera(seed, p.camera);
  if (variety > 0.0) add_variety(seed, variety, p);
  return p;
}

}  // namespace furrow::simulation
