#pragma once

#include <filesystem>

#include "furrow_annotation/coco.hpp"
#include "furrow_annotation/mask_reader.hpp"

namespace furrow::annotation {

/// Reads a data set of any known format: a COCO file, or a folder. A folder is tested in this
/// order: Carrot-Weed (plant_masks/), CWFID (annotations/ or masks/), COCO (evaluation.json). The
/// data set's name is that of the format; for COCO it is that of the file or folder.
/// resolution_mm_per_px is the file's, and an estimate for CWFID and Carrot-Weed. Errors: kNotFound
/// for other folders; else those of the formats' readers.
[[nodiscard]] Result<Dataset> read_dataset(const std::filesystem::path& path,
                                           const MaskReader& read_mask,
                                           const CocoOptions& options = {});

}  // namespace furrow::annotation
