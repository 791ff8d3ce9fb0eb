#include "furrow_simulation/light.hpp"

#include <algorithm>
#include <cmath>

namespace furrow::simulation {

void LightParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "sun_elevation_rad",
           .unit = "rad",
           .description = "height of the sun above the horizon",
           .min = 0.2,
           .max = 1.5708},
          sun_elevation_rad);
  v.visit({.name = "sun_azimuth_rad",
           .unit = "rad",
           .description = "where the sun stands, from the field's x axis counter-clockwise",
           .min = -6.2832,
           .max = 6.2832},
          sun_azimuth_rad);
  v.visit({.name = "diffuse_share",
           .description = "share of the sky in the light on level ground; 1 is overcast",
           .min = 0.05,
           .max = 1.0},
          diffuse_share);
  v.visit({.name = "exposure", .description = "gain of the light", .min = 0.1, .max = 5.0},
          exposure);
  v.visit({.name = "warmth",
           .description = "white balance: -1 bluish, 1 yellowish",
           .min = -1.0,
           .max = 1.0},
          warmth);
  v.visit({.name = "contrast", .description = "about middle grey", .min = 0.3, .max = 2.0},
          contrast);
  v.visit({.name = "saturation", .description = "of the colours", .min = 0.0, .max = 2.0},
          saturation);
  v.visit({.name = "robot_shadow", .description = "the robot's body shades a part of the picture"},
          robot_shadow);
  v.visit({.name = "robot_shadow_edge_m",
           .unit = "m",
           .description = "the edge of the robot's shadow, ahead of the optical axis; what lies "
                          "behind is shaded",
           .min = -5.0,
           .max = 5.0},
          robot_shadow_edge_m);
  v.visit({.name = "robot_shadow_angle_rad",
           .unit = "rad",
           .description = "turns that edge about the optical axis",
           .min = -6.2832,
           .max = 6.2832},
          robot_shadow_angle_rad);
}

Light::Light(const LightParameters& p)
    : contrast_(static_cast<float>(p.contrast)), saturation_(static_cast<float>(p.saturation)) {
  for (const double value : {p.sun_elevation_rad, p.sun_azimuth_rad, p.diffuse_share, p.exposure,
                             p.warmth, p.contrast, p.saturation}) {
    if (!std::isfinite(value)) throw ConfigError("light: every value must be finite");
  }
  const double elevation = std::clamp(p.sun_elevation_rad, 0.2, 1.5708);
  to_sun_ = Eigen::Vector3d(std::cos(elevation) * std::cos(p.sun_azimuth_rad),
                            std::cos(elevation) * std::sin(p.sun_azimuth_rad), std::sin(elevation))
                .cast<float>();
  const auto exposure = static_cast<float>(p.exposure);
  const auto diffuse = static_cast<float>(std::clamp(p.diffuse_share, 0.0, 1.0));
  const auto warmth = static_cast<float>(p.warmth);
  const Eigen::Array3f balance(1.0f + 0.22f * warmth, 1.0f, 1.0f - 0.22f * warmth);
  // A low sun is yellower; the sky is bluer than the sun.
  const float low = 1.0f - to_sun_.z();
  const Eigen::Array3f sun(1.0f + 0.08f * low, 1.0f, 1.0f - 0.20f * low);
  const Eigen::Array3f sky(0.96f, 1.0f, 1.06f);
  sun_rgb_ = exposure * (1.0f - diffuse) / std::max(to_sun_.z(), 0.35f) * (balance * sun);
  sky_rgb_ = exposure * diffuse * (balance * sky);
}

}  // namespace furrow::simulation
