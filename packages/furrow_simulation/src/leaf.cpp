#include "leaf.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace furrow::simulation {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

float half_width(Outline outline, float u) {
  const auto power = [](float x, float e) { return std::pow(std::clamp(x, 0.0f, 1.0f), e); };
  switch (outline) {
    case Outline::kOval:
      return power(std::sin(kPi * power(u, 0.85f)), 0.62f);
    case Outline::kPointed:
      return power(std::sin(kPi * power(u, 0.62f)), 0.9f);
    case Outline::kRhombic: {
      const float body = u < 0.36f ? power(u / 0.36f, 0.8f) : power((1.0f - u) / 0.64f, 0.75f);
      const float tooth = u > 0.22f ? std::abs(std::fmod(4.2f * u, 1.0f) - 0.5f) * 2.0f : 0.5f;
      return body * (0.80f + 0.32f * tooth);
    }
    case Outline::kStrap:
      return power(6.0f * u + 0.35f, 0.5f) * power(1.0f - u, 0.55f);
    case Outline::kRound:
      return std::sqrt(std::max(1.0f - (2.0f * u - 1.0f) * (2.0f * u - 1.0f), 0.0f));
    case Outline::kToothed: {
      const float tooth = std::fmod(5.0f * u + 0.2f, 1.0f);
      return power(std::sin(kPi * power(u, 1.15f)), 0.7f) * (0.38f + 0.75f * tooth);
    }
    case Outline::kObovate:
      return power(std::sin(kPi * power(u, 1.5f)), 0.8f);
  }
  return 0.0f;
}

void add_quad(PlantMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({b, d, c});
}

}  // namespace

Eigen::Vector3f add_leaf(PlantMesh& mesh, const Leaf& leaf) {
  const int columns = leaf.columns <= 2 ? 2 : 4;
  const int rows = std::max(leaf.rows, 2);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  Eigen::Vector3f spine = leaf.base;
  const float step = leaf.length / static_cast<float>(rows);
  for (int row = 0; row <= rows; ++row) {
    const float u = static_cast<float>(row) / static_cast<float>(rows);
    const float pitch = leaf.pitch_rad - leaf.droop_rad * u;
    const float azimuth = leaf.azimuth_rad + leaf.turn_rad * u;
    const Eigen::Vector3f side(-std::sin(azimuth), std::cos(azimuth), 0.0f);
    const Eigen::Vector3f up(-std::sin(pitch) * std::cos(azimuth),
                             -std::sin(pitch) * std::sin(azimuth), std::cos(pitch));
    const float half = 0.5f * leaf.width * std::max(half_width(leaf.outline, u), 0.02f);
    for (int column = 0; column <= columns; ++column) {
      const float s = 2.0f * static_cast<float>(column) / static_cast<float>(columns) - 1.0f;
      const float ripple =
          leaf.wave * leaf.length * s * s *
          std::sin(2.0f * kPi * leaf.waves * u + leaf.phase + (s > 0.0f ? 1.3f : 0.0f)) *
          std::min(4.0f * u, 1.0f);
      PlantVertex vertex;
      vertex.p_P = spine + side * (s * half) + up * (leaf.fold * half * std::abs(s) + ripple);
      vertex.leaf = {u, s};
      vertex.albedo_rgb = leaf.albedo_rgb;
      mesh.vertices.push_back(vertex);
    }
    if (row < rows) {
      spine += step * Eigen::Vector3f(std::cos(pitch) * std::cos(azimuth),
                                      std::cos(pitch) * std::sin(azimuth), std::sin(pitch));
    }
  }
  const auto width = static_cast<std::uint32_t>(columns + 1);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::uint32_t a =
          first + static_cast<std::uint32_t>(row) * width + static_cast<std::uint32_t>(column);
      add_quad(mesh, a, a + 1, a + width, a + width + 1);
    }
  }
  return spine;
}

void add_stalk(PlantMesh& mesh, const Eigen::Vector3f& from, const Eigen::Vector3f& to, float width,
               float sag, const Eigen::Vector3f& albedo_rgb) {
  constexpr int kRows = 4;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  Eigen::Vector3f side(from.y() - to.y(), to.x() - from.x(), 0.0f);
  const float norm = side.norm();
  side = norm > 1e-9f ? Eigen::Vector3f(side / norm) : Eigen::Vector3f(1.0f, 0.0f, 0.0f);
  for (int row = 0; row <= kRows; ++row) {
    const float u = static_cast<float>(row) / kRows;
    Eigen::Vector3f centre = from + u * (to - from);
    centre.z() += sag * 4.0f * u * (1.0f - u);
    for (int column = 0; column <= 2; ++column) {
      const auto s = static_cast<float>(column - 1);
      PlantVertex vertex;
      vertex.p_P = centre + side * (0.5f * width * (1.0f - 0.3f * u) * s);
      vertex.p_P.z() -= 0.35f * width * std::abs(s);  // a stalk is round
      vertex.leaf = {0.5f, 0.5f * s};
      vertex.albedo_rgb = albedo_rgb;
      mesh.vertices.push_back(vertex);
    }
  }
  for (std::uint32_t row = 0; row < kRows; ++row) {
    for (std::uint32_t column = 0; column < 2; ++column) {
      const std::uint32_t a = first + 3 * row + column;
      add_quad(mesh, a, a + 1, a + 3, a + 4);
    }
  }
}

void compute_normals(PlantMesh& mesh) {
  for (auto& vertex : mesh.vertices) vertex.normal_P.setZero();
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3f& a = mesh.vertices[t[0]].p_P;
    const Eigen::Vector3f normal = (mesh.vertices[t[1]].p_P - a).cross(mesh.vertices[t[2]].p_P - a);
    const Eigen::Vector3f upper = normal.z() < 0.0f ? Eigen::Vector3f(-normal) : normal;
    for (const std::uint32_t i : t) mesh.vertices[i].normal_P += upper;
  }
  for (auto& vertex : mesh.vertices) {
    const float norm = vertex.normal_P.norm();
    vertex.normal_P =
        norm > 1e-20f ? Eigen::Vector3f(vertex.normal_P / norm) : Eigen::Vector3f(0.0f, 0.0f, 1.0f);
  }
}

}  // namespace furrow::simulation
