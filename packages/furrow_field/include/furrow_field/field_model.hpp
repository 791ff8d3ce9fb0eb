#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

namespace furrow::field {

enum class PlantKind : std::uint8_t { kCrop, kWeed };

/// One plant. Positions in the field frame F: x along the row in the direction of travel, y to the
/// left, the ground at z = 0 on average.
struct Plant {
  std::int64_t id = 0;  ///< unique in its field
  PlantKind kind = PlantKind::kWeed;
  std::string species;                              ///< a name of the species table
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();  ///< the stem
  double radius_m = 0.0;                            ///< of the canopy seen from above
  double area_mm2 = 0.0;                            ///< leaf area seen from above
  int leaves = 2;                                   ///< growth stage; 2 counts cotyledons
  double heading_rad = 0.0;                         ///< of the first leaf
};

/// The plants of a stretch of field. `source` says where they come from, plainly ("generated:
/// poisson, 8.2 weeds/m2, seed 7"; "imported: FILE"), and stands beside every result made of them.
struct FieldModel {
  std::string name;
  std::string source;
  double length_m = 0.0;        ///< x in [0, length_m]
  double width_m = 0.0;         ///< y in [-width_m/2, width_m/2]
  std::vector<double> row_y_m;  ///< crop rows, along x
  std::vector<Plant> plants;    ///< in the order of x, then id
};

}  // namespace furrow::field
