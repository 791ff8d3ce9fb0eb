#pragma once

#include <filesystem>

#include "furrow_vision/annotated_image.hpp"

namespace furrow::vision {

/// COCO instance annotations (Lin et al. 2014): polygons, uncompressed and compressed RLE. A
/// category whose "supercategory" is "crop" is a crop, else a weed; a keypoint named "stem" is the
/// stem. Beyond COCO, each image may hold "pose" [x_m, y_m, heading_rad], "velocity_mps",
/// "stamp_ns", "sequence", "labelled" and "depth_file_name" (the structure of SB20 / SB21), and
/// each annotation "area_mm2" and "score". File names are relative to the annotation file's folder.
/// Pixels are not loaded. Errors name the file and the key of what is malformed.
[[nodiscard]] Result<Dataset> read_coco(const std::filesystem::path& file);

/// Writes what read_coco reads, masks as compressed RLE, so that they come back bit by bit. Image
/// paths become relative to the file's folder where they lie under it.
[[nodiscard]] Status write_coco(const std::filesystem::path& file, const Dataset& dataset);

/// Detections as an annotated image, each of its most probable class.
[[nodiscard]] std::vector<AnnotatedInstance> to_annotations(const std::vector<Instance>& instances,
                                                            const std::vector<SubClass>& classes);

}  // namespace furrow::vision
