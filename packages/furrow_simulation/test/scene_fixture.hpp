#pragma once

#include <Eigen/Geometry>
#include <cstring>
#include <utility>
#include <vector>

#include "furrow_simulation/renderer.hpp"

namespace furrow::simulation {

/// A camera that looks straight down, its upper edge towards +x.
inline Eigen::Isometry3d looking_down(double x_m, double y_m, double height_m) {
  Eigen::Isometry3d X_FC = Eigen::Isometry3d::Identity();
  X_FC.linear() << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  X_FC.translation() = Eigen::Vector3d(x_m, y_m, height_m);
  return X_FC;
}

inline geometry::PinholeCamera small_camera() {
  return geometry::PinholeCamera({320, 240, 217.5, 217.5, 159.5, 119.5});
}

inline field::Plant plant(std::int64_t id, const char* species, double x_m, double y_m,
                          double radius_m, double area_mm2, int leaves) {
  field::Plant p;
  p.id = id;
  p.kind =
      std::strcmp(species, "sugar_beet") == 0 ? field::PlantKind::kCrop : field::PlantKind::kWeed;
  p.species = species;
  p.p_F_m = {x_m, y_m};
  p.radius_m = radius_m;
  p.area_mm2 = area_mm2;
  p.leaves = leaves;
  return p;
}

inline field::FieldModel field_of(std::vector<field::Plant> plants) {
  field::FieldModel field;
  field.name = "test";
  field.length_m = 4.0;
  field.width_m = 2.0;
  field.plants = std::move(plants);
  return field;
}

inline bool same_bytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && a.isContinuous() && b.isContinuous() &&
         std::memcmp(a.data, b.data, a.total() * a.elemSize()) == 0;
}

inline bool same_bytes(const Frame& a, const Frame& b) {
  return same_bytes(a.bgr, b.bgr) && same_bytes(a.depth_m, b.depth_m) &&
         same_bytes(a.plant_index, b.plant_index);
}

}  // namespace furrow::simulation
