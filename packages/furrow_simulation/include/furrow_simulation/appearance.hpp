#pragma once

#include <cstdint>

#include "furrow_core/parameters.hpp"
#include "furrow_simulation/camera_effects.hpp"
#include "furrow_simulation/ground.hpp"
#include "furrow_simulation/light.hpp"
#include "furrow_simulation/plant_mesh.hpp"

namespace furrow::simulation {

/// Everything that decides how a rendered field looks. Declared as one flat list of parameters.
struct RendererParameters {
  GroundParameters ground;
  PlantParameters plants;
  LightParameters light;
  CameraEffectParameters camera;
  std::int64_t threads = 1;  ///< changes the time, not the bytes

  void visit(ParameterVisitor& v);
};

/// A random soil, light, condition of the plants, and camera, drawn widely, for training data.
/// Resolution and threads keep their defaults. Above 0, `variety` (up to 1) lets forms vary within
/// a species. A share of the images then gets a low sun with black shadows, lamps in the dark,
/// overexposed soil, many stones or much straw.
[[nodiscard]] RendererParameters random_appearance(std::uint64_t seed, double variety = 0.0);

}  // namespace furrow::simulation
