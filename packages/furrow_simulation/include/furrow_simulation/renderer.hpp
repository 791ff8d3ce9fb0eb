#pragma once

#include <cstdint>
#include <memory>

#include "furrow_simulation/appearance.hpp"
#include "furrow_simulation/scene.hpp"

namespace furrow::simulation {

/// Renders a field of plants on soil. Plants and ground are built where the camera first looks and
/// kept in bounded caches, so that a camera that moves slowly costs little per frame. Ground is
/// rendered up to 1.9 m (at 1 mm resolution; in proportion at others) along x and y around the
/// point at the image's centre, and within 5 km of F's origin.
class Renderer final : public Scene {
 public:
  /// `species` says how plants are drawn. Throws ConfigError for
  /// parameters that are not usable and for plants whose place is not within 5 km of F's origin.
  Renderer(field::FieldModel field, const RendererParameters& parameters, std::uint64_t seed,
           const field::SpeciesTable& species = field::SpeciesTable::defaults());
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
