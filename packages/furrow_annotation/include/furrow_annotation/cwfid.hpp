#pragma once

#include <filesystem>

#include "furrow_annotation/dataset.hpp"
#include "furrow_annotation/mask_reader.hpp"

namespace furrow::annotation {

/// The Crop/Weed Field Image Dataset (Haug and Ostermann 2014): images/NNN_image.png,
/// masks/NNN_mask.png (soil white), annotations/NNN_annotation.yaml. Instances are the polygons cut
/// with the vegetation mask; polygons without any vegetation are skipped. The polygons' numbers
/// are pixel indices. No stems. Errors name the file and the key.
[[nodiscard]] Result<Dataset> read_cwfid(const std::filesystem::path& folder,
                                         const MaskReader& read_mask);

}  // namespace furrow::annotation
