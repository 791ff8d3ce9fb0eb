#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

/// A plant as measured in an image. Pixel (0, 0) is the centre of the upper left pixel.
struct ImagePlant {
  PlantKind kind = PlantKind::kWeed;
  std::string species;  ///< empty: not known
  Eigen::Vector2d stem_px = Eigen::Vector2d::Zero();
  double area_px2 = 0.0;
  double radius_px = 0.0;  ///< from the stem to the farthest part of the plant
};

struct PlantImage {
  std::string name;
  int width_px = 0;
  int height_px = 0;
  std::vector<ImagePlant> plants;
};

struct LayoutParameters {
  double ground_resolution_mm_per_px = 1.0;
  double gap_m = 0.0;  ///< bare ground between images
  /// The image direction that lies along the row: "up" or "right".
  std::string travel = "up";

  void visit(ParameterVisitor& v);
};

/// The rectangle of an image on the ground: from x_m to x_m + length_m, centred on y = 0.
struct ImagePlacement {
  std::string image;
  int width_px = 0;
  int height_px = 0;
  double resolution_m_per_px = 0.0;
  bool travel_up = true;
  double x_m = 0.0;

  [[nodiscard]] double length_m() const;
  [[nodiscard]] double width_m() const;
  [[nodiscard]] Eigen::Vector2d to_field(const Eigen::Vector2d& pixel) const;
  [[nodiscard]] Eigen::Vector2d to_pixel(const Eigen::Vector2d& p_F_m) const;
};

struct LaidImages {
  FieldModel field;
  std::vector<ImagePlacement> placements;
  /// Number of plants that were skipped because their stem is outside their image.
  std::size_t outside = 0;
};

/// Places the images one after another along the row. `source` becomes FieldModel::source. Errors:
/// kInvalidArgument without an image, kOutOfRange for sizes and parameters outside their range.
[[nodiscard]] Result<LaidImages> lay_images(const std::vector<PlantImage>& images,
                                            const LayoutParameters& parameters,
                                            const std::string& name, const std::string& source);

}  // namespace furrow::field
