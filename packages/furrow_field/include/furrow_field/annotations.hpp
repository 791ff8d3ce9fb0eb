#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_field/field_model.hpp"

namespace furrow::field {

using Polygon = std::vector<Eigen::Vector2d>;

/// A plant as somebody drew it in an image. Pixel (0, 0) is the centre of the upper left pixel.
struct AnnotatedPlant {
  PlantKind kind = PlantKind::kWeed;
  std::string species;                     ///< empty: not known
  std::vector<Polygon> polygons_px;        ///< its parts; no holes
  std::optional<Eigen::Vector2d> stem_px;  ///< where it was marked
};

struct AnnotatedImage {
  std::string name;
  int width_px = 0;
  int height_px = 0;
  std::vector<AnnotatedPlant> plants;
};

/// Area in px2 by the shoelace formula, of either orientation.
[[nodiscard]] double polygon_area_px2(const Polygon& polygon);
/// The centroid of the area of all parts; the mean of the points where there is no area. Nothing
/// without points.
[[nodiscard]] std::optional<Eigen::Vector2d> centroid_px(const std::vector<Polygon>& polygons);

/// What a category of a data set stands for.
struct CategoryMeaning {
  PlantKind kind = PlantKind::kWeed;
  std::string species;
};

/// COCO instance annotations (images, annotations with polygon segmentations, categories), images
/// in the file's order. A category is looked up in `meanings` by its name; "crop" and "weed" need
/// no entry. The stem is the keypoint called "stem", where labelled. Crowd annotations are left
/// out. Errors (kParse, kOutOfRange, kNotFound for a category without a meaning) name the file, the
/// annotation and the key; run-length masks are refused.
[[nodiscard]] Result<std::vector<AnnotatedImage>> parse_coco(
    std::string_view json, std::string_view file,
    const std::map<std::string, CategoryMeaning>& meanings = {});

}  // namespace furrow::field
