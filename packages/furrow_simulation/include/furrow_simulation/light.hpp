#pragma once

#include <Eigen/Core>

#include "furrow_core/parameters.hpp"

namespace furrow::simulation {

/// Daylight: a sun and an even sky.
struct LightParameters {
  double sun_elevation_rad = 0.9;
  double sun_azimuth_rad = 0.8;
  double diffuse_share = 0.35;
  double exposure = 1.0;
  double warmth = 0.1;
  double contrast = 1.0;
  double saturation = 1.0;
  bool robot_shadow = false;
  double robot_shadow_edge_m = -0.2;
  double robot_shadow_angle_rad = 0.0;

  void visit(ParameterVisitor& v);
};

/// What shading needs of the parameters. Colours in linear RGB.
class Light {
 public:
  /// Throws ConfigError when a value is not finite.
  explicit Light(const LightParameters& parameters);

  /// A unit vector in F.
  [[nodiscard]] const Eigen::Vector3f& to_sun() const { return to_sun_; }
  [[nodiscard]] const Eigen::Vector3f& sun_rgb() const { return sun_rgb_; }
  [[nodiscard]] const Eigen::Vector3f& sky_rgb() const { return sky_rgb_; }

  /// The camera's response: linear RGB radiance to gamma-encoded BGR in [0, 255], with exposure
  /// already in the light, then contrast and saturation. The curve is a
  /// square root.
  [[nodiscard]] Eigen::Vector3f encode_bgr(const Eigen::Vector3f& linear_rgb) const {
    const Eigen::Array3f gamma = 255.0f * linear_rgb.array().max(0.0f).sqrt();
    const Eigen::Array3f stretched = (gamma - 118.0f) * contrast_ + 118.0f;
    const float luma = 0.3f * stretched.x() + 0.59f * stretched.y() + 0.11f * stretched.z();
    const Eigen::Array3f color = ((stretched - luma) * saturation_ + luma).max(0.0f).min(255.0f);
    return {color.z(), color.y(), color.x()};
  }

 private:
  Eigen::Vector3f to_sun_;
  Eigen::Vector3f sun_rgb_;
  Eigen::Vector3f sky_rgb_;
  float contrast_;
  float saturation_;
};

}  // namespace furrow::simulation
