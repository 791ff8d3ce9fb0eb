#pragma once

#include <filesystem>

#include "furrow_annotation/dataset.hpp"
#include "furrow_annotation/mask_reader.hpp"

namespace furrow::annotation {

/// Carrot-Weed (Lameski et al. 2017): images/NAME.jpg and plant_masks/NAME.png (0 soil, 1 weed,
/// 2 crop). Instances are the 8-connected components of each class of at least `min_area_px`; the
/// semantic mask stays whole in AnnotatedImage::vegetation. No stems. Errors name the file.
[[nodiscard]] Result<Dataset> read_carrot_weed(const std::filesystem::path& folder,
                                               const MaskReader& read_mask, int min_area_px = 50);

}  // namespace furrow::annotation
