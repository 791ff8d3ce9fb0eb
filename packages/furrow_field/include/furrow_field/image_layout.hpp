#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"
#include "furrow_field/annotations.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

struct LayoutParameters {
  double ground_resolution_mm_per_px = 1.0;
  double gap_m = 0.0;  ///< bare ground between images
  /// The image direction that lies along the row: "up" or "right".
  std::string travel = "up";

  void visit(ParameterVisitor& v);
};

/// Where an image lies on the ground: a rectangle from x_m to x_m + length_m, its middle on y = 0.
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
};

/// Lays the images' plants one after another along the row. A plant stands at its marked stem, else
/// at the centroid of its polygons; its radius is that of a disc that reaches its farthest polygon
/// point; its area comes from the polygons. Plants without points, or whose stem lies outside their
/// image, are an Error. `source` goes into the field as it is.
[[nodiscard]] Result<LaidImages> lay_images(const std::vector<AnnotatedImage>& images,
                                            const LayoutParameters& parameters,
                                            const std::string& name, const std::string& source);

}  // namespace furrow::field
