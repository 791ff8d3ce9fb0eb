#include "furrow_components/observation_conversion.hpp"

#include <vector>

namespace furrow::components {
namespace {

Result<tracking::GroundMask> footprint(const furrow_msgs::msg::PlantInstance& instance,
                                       const geometry::PinholeCamera& camera,
                                       const Eigen::Isometry3d& X_FC, double cell_m) {
  const auto& box = instance.box();
  const std::uint64_t width = box.width();
  const std::uint64_t pixels = width * box.height();
  const auto& image = camera.intrinsics();
  if (pixels >
      static_cast<std::uint64_t>(image.width_px) * static_cast<std::uint64_t>(image.height_px)) {
    return Error{ErrorCode::kParse, "the box is larger than the image"};
  }
  std::vector<Eigen::Vector2d> points_F;
  std::uint64_t at = 0;
  bool inside = false;
  for (const std::uint64_t run : instance.mask_runs()) {
    if (run > pixels - at) return Error{ErrorCode::kParse, "the mask is longer than its box"};
    for (std::uint64_t i = at; inside && i < at + run; ++i) {
      const Eigen::Vector2d pixel(static_cast<double>(box.x_offset() + i % width),
                                  static_cast<double>(box.y_offset() + i / width));
      points_F.push_back((X_FC * camera.unproject(pixel, instance.stem().z())).head<2>());
    }
    at += run;
    inside = !inside;
  }
  return tracking::GroundMask::from_points(points_F, cell_m);
}

}  // namespace

void ObservationParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "pixel_noise_px",
           .unit = "px",
           .description = "standard deviation of the pixel of a stem",
           .min = 0.01,
           .max = 100.0},
          pixel_noise_px);
  v.visit({.name = "depth_noise_m",
           .unit = "m",
           .description = "standard deviation of a depth",
           .min = 1e-4,
           .max = 1.0},
          depth_noise_m);
  v.visit(
      {.name = "footprints",
       .description = "project masks to the ground; the association iou uses them, else circles"},
      footprints);
  v.visit({.name = "footprint_cell_m",
           .unit = "m",
           .description = "cell size of masks on the ground",
           .min = 0.0005,
           .max = 0.1},
          footprint_cell_m);
}

Eigen::Matrix3d planar_covariance(const nav_msgs::msg::Odometry& message) {
  // Row-major 6x6 over (x, y, z, roll, pitch, yaw).
  constexpr std::size_t kIndex[] = {0, 1, 5};
  Eigen::Matrix3d covariance;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      covariance(row, column) = message.pose().covariance()[kIndex[row] * 6 + kIndex[column]];
    }
  }
  return covariance;
}

Result<tracking::Observation> observe(const furrow_msgs::msg::PlantInstance& instance,
                                      const geometry::PinholeCamera& camera,
                                      const Eigen::Isometry3d& X_FC,
                                      const ObservationParameters& parameters) {
  const Eigen::Vector2d pixel(instance.stem_u_px(), instance.stem_v_px());
  const auto point =
      tracking::reproject_point(camera, X_FC, pixel, instance.stem().z(),
                                {parameters.pixel_noise_px, parameters.depth_noise_m});
  if (!point.ok()) return point.error();
  tracking::Observation observation;
  observation.p_F_m = point->p_F_m.head<2>();
  observation.covariance_F_m2 = point->covariance_F_m2;
  observation.radius_m = instance.radius_m();
  observation.area_mm2 = instance.area_mm2();
  observation.leaves = instance.leaves();
  observation.score = instance.score();
  const double crop = instance.crop_probability();
  observation.class_probability = {crop, 1.0 - crop};
  const auto& box = instance.box();
  const auto& size = camera.intrinsics();
  observation.truncated =
      box.x_offset() == 0 || box.y_offset() == 0 ||
      box.x_offset() + box.width() >= static_cast<std::uint32_t>(size.width_px) ||
      box.y_offset() + box.height() >= static_cast<std::uint32_t>(size.height_px);
  if (parameters.footprints && !instance.mask_runs().empty()) {
    auto mask = footprint(instance, camera, X_FC, parameters.footprint_cell_m);
    if (!mask.ok()) return mask.error();
    observation.footprint = std::move(mask).value();
  }
  return observation;
}

}  // namespace furrow::components
