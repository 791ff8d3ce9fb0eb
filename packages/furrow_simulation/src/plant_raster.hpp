#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "furrow_simulation/scene.hpp"
#include "plant_cache.hpp"
#include "view.hpp"

namespace furrow::simulation {

/// A plant in the image.
struct PlacedPlant {
  /// What is interpolated over a triangle: inverse depth, b, g, r, shade, along and across the
  /// leaf.
  using Attributes = Eigen::Array<float, 8, 1>;
  struct Corner {
    Eigen::Vector2f pixel;
    Attributes attributes;
  };

  std::size_t plant_index = 0;
  const BuiltPlant* built = nullptr;
  std::vector<Corner> corners;  ///< one a vertex; inverse depth 0: behind the camera
  int first_row = 0;            ///< rows of the image that it may touch
  int end_row = 0;
  Eigen::Vector2d stem_px = Eigen::Vector2d::Zero();
  std::int64_t visible_px = 0;
};

/// nullopt when no part of the plant can be in the image. `sway_F` is the displacement of a leaf by
/// wind, in m for each metre above the ground.
[[nodiscard]] std::optional<PlacedPlant> place_plant(const View& view, const BuiltPlant& plant,
                                                     std::size_t plant_index,
                                                     const Eigen::Vector2f& sway_F);

/// Draws rows [first_row, end_row) wherever the plant is nearer than earlier plants: colours,
/// inverse depths (1/m) into frame.depth_m, and `local_index` into frame.plant_index.
void draw_plant(const PlacedPlant& plant, std::int32_t local_index, const LeafTexture& texture,
                const RobotShadow& shadow, Frame& frame, int first_row, int end_row);

}  // namespace furrow::simulation
