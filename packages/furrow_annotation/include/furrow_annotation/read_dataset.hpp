#pragma once

#include <filesystem>

#include "furrow_annotation/coco.hpp"
#include "furrow_annotation/mask_reader.hpp"

namespace furrow::annotation {

/// Reads a data set of any format known here: a COCO file; or a folder of Carrot-Weed
/// (plant_masks/), of CWFID (annotations/ or masks/), or with a COCO file evaluation.json, looked
/// for in this order. The name is that of the format or, of COCO, of the file or folder.
/// resolution_mm_per_px is set as the file says it, and estimated for CWFID and Carrot-Weed.
/// kNotFound for anything else; further errors as the formats' readers.
[[nodiscard]] Result<Dataset> read_dataset(const std::filesystem::path& path,
                                           const MaskReader& read_mask,
                                           const CocoOptions& options = {});

}  // namespace furrow::annotation
