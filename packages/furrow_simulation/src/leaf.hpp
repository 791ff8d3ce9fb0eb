#pragma once

#include <cstdint>

#include "furrow_simulation/plant_mesh.hpp"

namespace furrow::simulation {

/// Half the width of a blade along its midrib, as a share of the widest place.
enum class Outline : std::uint8_t {
  kOval,     ///< rounded at both ends
  kPointed,  ///< widest below the middle, drawn out to a tip
  kRhombic,  ///< widest at a third, with blunt teeth
  kStrap,    ///< nearly parallel, tapering at the end
  kRound,    ///< a disc
  kToothed,  ///< deep, sharp teeth on both sides
  kObovate,  ///< widest towards the tip
};

struct Leaf {
  Eigen::Vector3f base = Eigen::Vector3f::Zero();  ///< where the blade begins
  float azimuth_rad = 0.0f;
  float pitch_rad = 0.3f;  ///< of the midrib at the base, above the horizontal
  float droop_rad = 0.5f;  ///< how much the pitch falls along the blade
  float turn_rad = 0.0f;   ///< sideways curve along the blade
  float length = 1.0f;
  float width = 0.5f;  ///< at the widest place, both halves
  float fold = 0.15f;  ///< the halves rise from the midrib, as a share of their width
  float wave = 0.0f;   ///< undulation of the margin, as a share of the length
  float waves = 2.5f;  ///< along the blade
  float phase = 0.0f;
  Outline outline = Outline::kOval;
  int rows = 10;    ///< quads along the blade
  int columns = 4;  ///< quads across: 2 or 4
  Eigen::Vector3f albedo_rgb = Eigen::Vector3f::Zero();
};

/// Adds a blade. Returns the end of its midrib.
Eigen::Vector3f add_leaf(PlantMesh& mesh, const Leaf& leaf);

/// Adds a stalk from `from` to `to`, bent upwards by `sag` (negative: downwards) in its middle.
void add_stalk(PlantMesh& mesh, const Eigen::Vector3f& from, const Eigen::Vector3f& to, float width,
               float sag, const Eigen::Vector3f& albedo_rgb);

/// Sets the vertices' normals from the triangles, turned to the upper side.
void compute_normals(PlantMesh& mesh);

}  // namespace furrow::simulation
