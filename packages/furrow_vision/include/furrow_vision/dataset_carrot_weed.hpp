#pragma once

#include <filesystem>

#include "furrow_vision/annotated_image.hpp"

namespace furrow::vision {

/// Carrot-Weed (Lameski et al. 2017): images/NAME.jpg and plant_masks/NAME.png (0 soil, 1 weed,
/// 2 crop). Instances are the 8-connected components of each class of at least `min_area_px`; the
/// semantic mask stays whole in their union with `vegetation`. No stems. Pixels are not loaded.
[[nodiscard]] Result<Dataset> read_carrot_weed(const std::filesystem::path& folder,
                                               int min_area_px = 50);

}  // namespace furrow::vision
