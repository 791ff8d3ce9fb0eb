#include "furrow_field/field_model.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace furrow::field {
namespace {

bool is_plain_text(const std::string& text) {
  return std::none_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7F;
  });
}

bool comes_before(const Plant& a, const Plant& b) {
  return a.p_F_m.x() != b.p_F_m.x() ? a.p_F_m.x() < b.p_F_m.x() : a.id < b.id;
}

Error error(ErrorCode code, const std::string& message) {
  return {code, message};
}

Status validate_extent(const FieldModel& field) {
  if (!is_plain_text(field.name) || !is_plain_text(field.source)) {
    return error(ErrorCode::kInvalidArgument, "field: name or source holds a control character");
  }
  if (!(field.length_m >= 0.0 && field.length_m <= kMaxFieldLength_m)) {
    return error(ErrorCode::kOutOfRange, "field: length_m must be in [0, 10000]");
  }
  if (!(field.width_m >= 0.0 && field.width_m <= kMaxFieldWidth_m)) {
    return error(ErrorCode::kOutOfRange, "field: width_m must be in [0, 1000]");
  }
  for (const double y_m : field.row_y_m) {
    if (!std::isfinite(y_m)) {
      return error(ErrorCode::kOutOfRange, "field: row_y_m holds a value that is not finite");
    }
  }
  if (field.row_y_m.size() > kMaxPlants || field.plants.size() > kMaxPlants) {
    return error(ErrorCode::kOutOfRange, "field: more than 1000000 plants or rows");
  }
  return {};
}

Status validate_plant(const Plant& plant, const FieldModel& field) {
  const std::string name = "plant " + std::to_string(plant.id);
  if (!is_plain_text(plant.species)) {
    return error(ErrorCode::kInvalidArgument, name + ": species holds a control character");
  }
  if (!plant.p_F_m.allFinite() || !std::isfinite(plant.heading_rad)) {
    return error(ErrorCode::kOutOfRange, name + ": position or heading is not finite");
  }
  const bool inside = plant.p_F_m.x() >= 0.0 && plant.p_F_m.x() <= field.length_m &&
                      std::abs(plant.p_F_m.y()) <= 0.5 * field.width_m;
  if (!inside) return error(ErrorCode::kOutOfRange, name + ": stands outside the field");
  if (!(std::isfinite(plant.radius_m) && plant.radius_m >= 0.0)) {
    return error(ErrorCode::kOutOfRange, name + ": radius_m must be finite and not negative");
  }
  if (!(std::isfinite(plant.area_mm2) && plant.area_mm2 >= 0.0)) {
    return error(ErrorCode::kOutOfRange, name + ": area_mm2 must be finite and not negative");
  }
  if (plant.leaves < 0) return error(ErrorCode::kOutOfRange, name + ": leaves is negative");
  return {};
}

}  // namespace

std::string_view to_string(PlantKind kind) {
  return kind == PlantKind::kCrop ? "crop" : "weed";
}

std::optional<PlantKind> plant_kind_from(std::string_view text) {
  if (text == "crop") return PlantKind::kCrop;
  if (text == "weed") return PlantKind::kWeed;
  return std::nullopt;
}

Status validate(const FieldModel& field) {
  if (Status status = validate_extent(field); !status.ok()) return status;
  std::unordered_set<std::int64_t> ids;
  ids.reserve(field.plants.size());
  for (std::size_t i = 0; i < field.plants.size(); ++i) {
    const Plant& plant = field.plants[i];
    if (Status status = validate_plant(plant, field); !status.ok()) return status;
    if (!ids.insert(plant.id).second) {
      return error(ErrorCode::kInvalidArgument,
                   "plant " + std::to_string(plant.id) + ": its id is not unique");
    }
    if (i > 0 && comes_before(plant, field.plants[i - 1])) {
      return error(ErrorCode::kInvalidArgument,
                   "plant " + std::to_string(plant.id) + ": not in the order of x, then id");
    }
  }
  return {};
}

void sort_plants(FieldModel& field) {
  std::sort(field.plants.begin(), field.plants.end(), comes_before);
}

}  // namespace furrow::field
