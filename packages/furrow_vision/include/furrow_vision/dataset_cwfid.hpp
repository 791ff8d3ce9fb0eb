#pragma once

#include <filesystem>

#include "furrow_vision/annotated_image.hpp"

namespace furrow::vision {

/// The Crop/Weed Field Image Dataset (Haug and Ostermann 2014): images/NNN_image.png,
/// masks/NNN_mask.png, annotations/NNN_annotation.yaml. Instances are the polygons cut with the
/// vegetation mask; polygons without any vegetation are left out. No stems. Pixels are not loaded.
/// Errors name the file and the key.
[[nodiscard]] Result<Dataset> read_cwfid(const std::filesystem::path& folder);

}  // namespace furrow::vision
