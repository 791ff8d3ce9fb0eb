#include "furrow_tracking/reprojection.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "furrow_core/statistics.hpp"

namespace furrow::tracking {
namespace {

Error invalid(const char* message) {
  return Error{ErrorCode::kInvalidArgument, message};
}

bool well_formed(const DepthImage& depth) {
  return depth.data_m != nullptr && depth.width_px > 0 && depth.height_px > 0 &&
         depth.stride >= depth.width_px;
}

bool has_depth(float depth_m) {
  return std::isfinite(depth_m) && depth_m > 0.0F;
}

}  // namespace

Result<GroundPoint> reproject_point(const geometry::PinholeCamera& camera,
                                    const Eigen::Isometry3d& X_FC, const Eigen::Vector2d& pixel,
                                    double depth_m, const PixelNoise& noise) {
  if (!X_FC.matrix().allFinite()) return invalid("the camera's pose is not finite");
  if (!pixel.allFinite()) return invalid("the pixel is not finite");
  if (!std::isfinite(depth_m) || depth_m <= 0.0) return invalid("the depth is not positive");
  if (!std::isfinite(noise.pixel_px) || noise.pixel_px <= 0.0 || !std::isfinite(noise.depth_m) ||
      noise.depth_m <= 0.0) {
    return invalid("the pixel noise is not positive");
  }
  const geometry::CameraIntrinsics& k = camera.intrinsics();
  const Eigen::Vector3d p_C = camera.unproject(pixel, depth_m);
  Eigen::Matrix3d by_noise_C = Eigen::Matrix3d::Zero();
  by_noise_C(0, 0) = depth_m / k.fx_px * noise.pixel_px;
  by_noise_C(1, 1) = depth_m / k.fy_px * noise.pixel_px;
  by_noise_C.col(2) = p_C / depth_m * noise.depth_m;
  const Eigen::Matrix<double, 2, 3> by_noise_F = X_FC.linear().topRows<2>() * by_noise_C;
  return GroundPoint{X_FC * p_C, by_noise_F * by_noise_F.transpose()};
}

Result<double> depth_near(const DepthImage& depth, const Eigen::Vector2d& pixel,
                          int half_width_px) {
  if (!well_formed(depth)) return invalid("the depth image is malformed");
  if (half_width_px < 0 || half_width_px > 64) return invalid("the half width is not in [0, 64]");
  if (!pixel.allFinite() || pixel.x() < -0.5 || pixel.y() < -0.5 ||
      pixel.x() >= depth.width_px - 0.5 || pixel.y() >= depth.height_px - 0.5) {
    return invalid("the pixel is not in the depth image");
  }
  const int u = static_cast<int>(std::floor(pixel.x() + 0.5));
  const int v = static_cast<int>(std::floor(pixel.y() + 0.5));
  std::vector<float> values_m;
  for (int y = std::max(0, v - half_width_px);
       y <= std::min(depth.height_px - 1, v + half_width_px); ++y) {
    for (int x = std::max(0, u - half_width_px);
         x <= std::min(depth.width_px - 1, u + half_width_px); ++x) {
      const float value_m = depth.data_m[y * depth.stride + x];
      if (has_depth(value_m)) values_m.push_back(value_m);
    }
  }
  if (values_m.empty()) return Error{ErrorCode::kNotFound, "no depth near the pixel"};
  return static_cast<double>(median_element(std::span(values_m)));
}

Result<GroundFootprint> reproject_mask(const geometry::PinholeCamera& camera,
                                       const Eigen::Isometry3d& X_FC, const InstanceMask& mask,
                                       const DepthImage& depth, double cell_m) {
  if (!X_FC.matrix().allFinite()) return invalid("the camera's pose is not finite");
  if (!(cell_m > 0.0) || !std::isfinite(cell_m)) return invalid("the cell is not positive");
  if (!well_formed(depth)) return invalid("the depth image is malformed");
  if (mask.data == nullptr || mask.width_px <= 0 || mask.height_px <= 0 ||
      mask.stride < mask.width_px) {
    return invalid("the instance's mask is malformed");
  }
  if (mask.u0_px < 0 || mask.v0_px < 0 || mask.width_px > depth.width_px - mask.u0_px ||
      mask.height_px > depth.height_px - mask.v0_px) {
    return invalid("the instance's box is not inside the depth image");
  }

  GroundFootprint footprint;
  std::vector<Eigen::Vector2d> points_F;
  for (int row = 0; row < mask.height_px; ++row) {
    const int v = mask.v0_px + row;
    for (int column = 0; column < mask.width_px; ++column) {
      if (mask.data[row * mask.stride + column] == 0) continue;
      const int u = mask.u0_px + column;
      const float depth_m = depth.data_m[v * depth.stride + u];
      if (!has_depth(depth_m)) {
        ++footprint.pixels_without_depth;
        continue;
      }
      const Eigen::Vector3d p_C = camera.unproject(Eigen::Vector2d(u, v), depth_m);
      points_F.emplace_back((X_FC * p_C).head<2>());
      footprint.area_mm2 += camera.pixel_area_mm2(depth_m);
    }
  }
  footprint.mask = GroundMask::from_points(points_F, cell_m);
  const auto centroid_F = footprint.mask.centroid();
  if (!centroid_F) return Error{ErrorCode::kNotFound, "no pixel of the mask has a depth"};
  for (const Eigen::Vector2d& point_F : points_F) {
    footprint.radius_m = std::max(footprint.radius_m, (point_F - *centroid_F).norm());
  }
  return footprint;
}

}  // namespace furrow::tracking
