#include "plant_raster.hpp"

#include <algorithm>
#include <cmath>

#include "raster.hpp"

namespace furrow::simulation {
namespace {

constexpr float kNear_m = 0.02f;
enum Attribute { kInverseDepth, kBlue, kGreen, kRed, kShade, kAlong, kAcross };

}  // namespace

std::optional<PlacedPlant> place_plant(const View& view, const BuiltPlant& plant,
                                       std::size_t plant_index, const Eigen::Vector2f& sway_F) {
  const auto& camera = view.intrinsics();
  PlacedPlant placed;
  placed.plant_index = plant_index;
  placed.built = &plant;
  const Eigen::Vector3d p_CP = view.pose_inverse() * plant.p_F.cast<double>();
  const Eigen::Vector3f origin = p_CP.cast<float>();
  // Sheared along the ground, so that stems stay where they are.
  Eigen::Matrix3f R_CF = view.pose_inverse().linear().cast<float>();
  R_CF.col(2) += R_CF.leftCols<2>() * sway_F;
  const auto fx = static_cast<float>(camera.fx_px);
  const auto fy = static_cast<float>(camera.fy_px);
  const auto cx = static_cast<float>(camera.cx_px);
  const auto cy = static_cast<float>(camera.cy_px);
  Eigen::Vector2f low(1e9f, 1e9f);
  Eigen::Vector2f high(-1e9f, -1e9f);
  placed.corners.reserve(plant.mesh.vertices.size());
  for (std::size_t i = 0; i < plant.mesh.vertices.size(); ++i) {
    const PlantVertex& vertex = plant.mesh.vertices[i];
    const VertexLight& light = plant.lights[i];
    const Eigen::Vector3f p_C = origin + R_CF * vertex.p_P;
    PlacedPlant::Corner corner;
    corner.attributes << 0.0f, light.bgr.x(), light.bgr.y(), light.bgr.z(), light.shade,
        vertex.leaf.x(), vertex.leaf.y(), 0.0f;
    corner.pixel.setZero();
    if (p_C.z() > kNear_m) {
      const float inverse = 1.0f / p_C.z();
      corner.attributes[kInverseDepth] = inverse;
      corner.pixel = {fx * p_C.x() * inverse + cx, fy * p_C.y() * inverse + cy};
      low = low.cwiseMin(corner.pixel);
      high = high.cwiseMax(corner.pixel);
    }
    placed.corners.push_back(corner);
  }
  const auto width = static_cast<float>(camera.width_px);
  const auto height = static_cast<float>(camera.height_px);
  if (high.x() < 0.0f || high.y() < 0.0f || low.x() >= width || low.y() >= height) {
    return std::nullopt;
  }
  placed.first_row = static_cast<int>(std::max(low.y(), 0.0f));
  placed.end_row = static_cast<int>(std::min(high.y() + 1.0f, height));
  if (p_CP.z() > static_cast<double>(kNear_m)) {
    placed.stem_px = {camera.fx_px * p_CP.x() / p_CP.z() + camera.cx_px,
                      camera.fy_px * p_CP.y() / p_CP.z() + camera.cy_px};
  }
  return placed;
}

void draw_plant(const PlacedPlant& plant, std::int32_t local_index, const LeafTexture& texture,
                const RobotShadow& shadow, Frame& frame, int first_row, int end_row) {
  const int first = std::max(first_row, plant.first_row);
  const int end = std::min(end_row, plant.end_row);
  if (first >= end) return;
  for (const auto& t : plant.built->mesh.triangles) {
    const auto& a = plant.corners[t[0]];
    const auto& b = plant.corners[t[1]];
    const auto& c = plant.corners[t[2]];
    if (std::min({a.attributes[0], b.attributes[0], c.attributes[0]}) <= 0.0f) continue;
    const Eigen::Vector2f ab = b.pixel - a.pixel;
    const Eigen::Vector2f ac = c.pixel - a.pixel;
    const float area = ab.x() * ac.y() - ac.x() * ab.y();
    if (!(std::abs(area) > 1e-5f)) continue;
    const float inverse_area = 1.0f / area;
    const PlacedPlant::Attributes to_b = b.attributes - a.attributes;
    const PlacedPlant::Attributes to_c = c.attributes - a.attributes;
    const PlacedPlant::Attributes per_x = (to_b * ac.y() - to_c * ab.y()) * inverse_area;
    const PlacedPlant::Attributes per_y = (to_c * ab.x() - to_b * ac.x()) * inverse_area;
    scan_triangle(
        a.pixel, b.pixel, c.pixel, frame.bgr.cols, first, end, [&](int v, int u_first, int u_end) {
          auto* bgr = frame.bgr.ptr<std::uint8_t>(v);
          auto* inverse_depth = frame.depth_m.ptr<float>(v);
          auto* index = frame.plant_index.ptr<std::int32_t>(v);
          PlacedPlant::Attributes value = a.attributes +
                                          per_x * (static_cast<float>(u_first) - a.pixel.x()) +
                                          per_y * (static_cast<float>(v) - a.pixel.y());
          for (int u = u_first; u < u_end; ++u, value += per_x) {
            if (value[kInverseDepth] <= inverse_depth[u]) continue;
            inverse_depth[u] = value[kInverseDepth];
            index[u] = local_index;
            float gain = texture.sample(value[kAlong], value[kAcross]);
            if (shadow.enabled()) gain *= shadow.gain(u, v, std::clamp(value[kShade], 0.0f, 1.0f));
            for (int k = 0; k < 3; ++k) {
              bgr[3 * u + k] =
                  static_cast<std::uint8_t>(std::clamp(value[kBlue + k] * gain, 0.0f, 255.0f));
            }
          }
        });
  }
}

}  // namespace furrow::simulation
