#include "furrow_components/field_conversion.hpp"

#include <algorithm>

#include "furrow_components/conversions.hpp"

namespace furrow::components {

furrow_msgs::msg::TrueField to_msg(const field::FieldModel& field, Time stamp) {
  furrow_msgs::msg::TrueField message;
  message.header(header(stamp, kFieldFrame));
  message.name(field.name);
  message.source(field.source);
  message.length_m(field.length_m);
  message.width_m(field.width_m);
  message.row_y_m(field.row_y_m);
  for (const field::Plant& plant : field.plants) {
    furrow_msgs::msg::TruePlant& entry = message.plants().emplace_back();
    entry.id(plant.id);
    entry.crop(plant.kind == field::PlantKind::kCrop);
    entry.species(plant.species);
    entry.position(to_point(plant.p_F_m));
    entry.radius_m(plant.radius_m);
    entry.area_mm2(plant.area_mm2);
    entry.leaves(static_cast<std::uint8_t>(std::clamp(plant.leaves, 0, 255)));
    entry.heading_rad(plant.heading_rad);
  }
  return message;
}

field::FieldModel from_msg(const furrow_msgs::msg::TrueField& message) {
  field::FieldModel field{.name = message.name(),
                          .source = message.source(),
                          .length_m = message.length_m(),
                          .width_m = message.width_m(),
                          .row_y_m = message.row_y_m()};
  for (const furrow_msgs::msg::TruePlant& entry : message.plants()) {
    field.plants.push_back(
        {.id = entry.id(),
         .kind = entry.crop() ? field::PlantKind::kCrop : field::PlantKind::kWeed,
         .species = entry.species(),
         .p_F_m = from_point(entry.position()).head<2>(),
         .radius_m = entry.radius_m(),
         .area_mm2 = entry.area_mm2(),
         .leaves = entry.leaves(),
         .heading_rad = entry.heading_rad()});
  }
  return field;
}

}  // namespace furrow::components
