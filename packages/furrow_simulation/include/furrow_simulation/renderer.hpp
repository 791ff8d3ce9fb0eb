#pragma once

#include <cstdint>
#include <memory>

#include "furrow_simulation/appearance.hpp"
#include "furrow_simulation/scene.hpp"

namespace furrow::simulation {

/// Renders a field of plants on soil. Plants and ground are built where the camera first looks and
/// kept in bounded caches, so that a camera that moves slowly costs little per frame. Ground is
/// rendered up to 2 m around the point under the image's centre.
class Renderer final : public Scene {
 public:
  /// Throws ConfigError for parameters that are not usable.
  Renderer(field::FieldModel field, const RendererParameters& parameters, std::uint64_t seed);
  ~Renderer() override;
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  [[nodiscard]] const field::FieldModel& field() const override;
  [[nodiscard]] Frame render(const geometry::PinholeCamera& camera, const Eigen::Isometry3d& X_FC,
                             std::uint64_t frame_index) override;

  /// Leaf area of a plant seen from straight above, measured on its mesh.
  /// @pre plant_index < field().plants.size().
  [[nodiscard]] double plant_area_mm2(std::size_t plant_index);
  /// The smooth ground's height, on which plants stand.
  [[nodiscard]] double ground_height_m(double x_F_m, double y_F_m) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace furrow::simulation
