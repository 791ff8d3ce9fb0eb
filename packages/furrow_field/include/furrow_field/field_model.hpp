#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"

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

/// The plants of a stretch of field. `source` is their origin ("generated: poisson, 8.2 weeds/m2,
/// seed 7"; "imported: FILE"); every result shows it.
struct FieldModel {
  std::string name;
  std::string source;
  double length_m = 0.0;        ///< x in [0, length_m]
  double width_m = 0.0;         ///< y in [-width_m/2, width_m/2]
  std::vector<double> row_y_m;  ///< crop rows, along x
  std::vector<Plant> plants;    ///< in the order of x, then id
};

/// More than a day's work of any robot; files and generators refuse larger fields.
inline constexpr std::size_t kMaxPlants = 1'000'000;
inline constexpr double kMaxFieldLength_m = 10'000.0;
inline constexpr double kMaxFieldWidth_m = 1'000.0;

/// "crop", "weed".
[[nodiscard]] std::string_view to_string(PlantKind kind);
/// Empty for any other text.
[[nodiscard]] std::optional<PlantKind> plant_kind_from(std::string_view text);

/// Checks the invariants of FieldModel: finite numbers, plants inside the field, unique ids, the
/// order, texts without control characters, the bounds above. The Error names the plant.
[[nodiscard]] Status validate(const FieldModel& field);

/// Sorts plants into the order of FieldModel.
void sort_plants(FieldModel& field);

}  // namespace furrow::field
