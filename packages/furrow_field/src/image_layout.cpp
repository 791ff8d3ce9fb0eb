#include "furrow_field/image_layout.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace furrow::field {
namespace {

constexpr int kLargestSide_px = 100'000;

bool is_inside(const ImagePlant& plant, const ImagePlacement& placement) {
  const Eigen::Vector2d& stem_px = plant.stem_px;
  return stem_px.allFinite() && stem_px.x() >= -0.5 && stem_px.y() >= -0.5 &&
         stem_px.x() <= placement.width_px - 0.5 && stem_px.y() <= placement.height_px - 0.5;
}

Plant place(const ImagePlant& measured, const ImagePlacement& placement) {
  const double resolution_m = placement.resolution_m_per_px;
  Plant plant;
  plant.kind = measured.kind;
  plant.species = measured.species;
  plant.p_F_m = placement.to_field(measured.stem_px);
  plant.radius_m = measured.radius_px * resolution_m;
  plant.area_mm2 = 1e6 * measured.area_px2 * resolution_m * resolution_m;
  return plant;
}

/// Rounding must not push a stem on the outer edge out of the field.
void keep_inside(FieldModel& field) {
  for (Plant& plant : field.plants) {
    plant.p_F_m.x() = std::clamp(plant.p_F_m.x(), 0.0, field.length_m);
    plant.p_F_m.y() = std::clamp(plant.p_F_m.y(), -0.5 * field.width_m, 0.5 * field.width_m);
  }
}

}  // namespace

void LayoutParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "ground_resolution_mm_per_px",
           .unit = "mm",
           .description = "ground of a pixel",
           .min = 0.001,
           .max = 100.0},
          ground_resolution_mm_per_px);
  v.visit({.name = "gap_m",
           .unit = "m",
           .description = "bare ground between images",
           .min = 0.0,
           .max = 100.0},
          gap_m);
  v.visit({.name = "travel",
           .description = "the image direction that lies along the row",
           .choices = {"up", "right"}},
          travel);
}

double ImagePlacement::length_m() const {
  return resolution_m_per_px * (travel_up ? height_px : width_px);
}

double ImagePlacement::width_m() const {
  return resolution_m_per_px * (travel_up ? width_px : height_px);
}

Eigen::Vector2d ImagePlacement::to_field(const Eigen::Vector2d& pixel) const {
  if (travel_up) {
    return {x_m + resolution_m_per_px * (height_px - 0.5 - pixel.y()),
            resolution_m_per_px * (0.5 * (width_px - 1) - pixel.x())};
  }
  return {x_m + resolution_m_per_px * (pixel.x() + 0.5),
          resolution_m_per_px * (0.5 * (height_px - 1) - pixel.y())};
}

Eigen::Vector2d ImagePlacement::to_pixel(const Eigen::Vector2d& p_F_m) const {
  const double along_px = (p_F_m.x() - x_m) / resolution_m_per_px;
  const double left_px = p_F_m.y() / resolution_m_per_px;
  if (travel_up) return {0.5 * (width_px - 1) - left_px, height_px - 0.5 - along_px};
  return {along_px - 0.5, 0.5 * (height_px - 1) - left_px};
}

Result<LaidImages> lay_images(const std::vector<PlantImage>& images,
                              const LayoutParameters& parameters, const std::string& name,
                              const std::string& source) {
  try {
    validate_parameters(parameters);
  } catch (const ConfigError& error) {
    return Error{ErrorCode::kOutOfRange, error.what()};
  }
  if (images.empty()) return Error{ErrorCode::kInvalidArgument, "there is no image to lay out"};
  LaidImages laid;
  FieldModel& field = laid.field;
  field.name = name;
  field.source = source;
  double x_m = 0.0;
  for (const PlantImage& image : images) {
    if (image.width_px < 1 || image.height_px < 1 || image.width_px > kLargestSide_px ||
        image.height_px > kLargestSide_px) {
      return Error{ErrorCode::kOutOfRange,
                   "image '" + image.name + "': its size must be in [1, 100000] pixels"};
    }
    const ImagePlacement placement{image.name,
                                   image.width_px,
                                   image.height_px,
                                   1e-3 * parameters.ground_resolution_mm_per_px,
                                   parameters.travel == "up",
                                   x_m};
    for (const ImagePlant& plant : image.plants) {
      if (is_inside(plant, placement)) {
        field.plants.push_back(place(plant, placement));
      } else {
        ++laid.outside;
      }
    }
    field.length_m = x_m + placement.length_m();
    field.width_m = std::max(field.width_m, placement.width_m());
    x_m = field.length_m + parameters.gap_m;
    laid.placements.push_back(placement);
  }
  keep_inside(field);
  sort_plants(field);
  std::int64_t id = 0;
  for (Plant& plant : field.plants) plant.id = id++;
  if (Status status = validate(field); !status.ok()) return status.error();
  return laid;
}

}  // namespace furrow::field
