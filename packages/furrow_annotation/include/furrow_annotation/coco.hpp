#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "furrow_annotation/dataset.hpp"
#include "furrow_core/result.hpp"

/// COCO instance annotations (Lin et al. 2014), read as pycocotools reads them.
///
/// Coordinates. COCO's polygons and boxes are measured from the upper left CORNER of the image; its
/// keypoints are pixel indices, that is, from the CENTRE of the upper left pixel (as Detectron2
/// reads them too). Polygons and boxes become masks here; a stem stays as the file says it.
///
/// Stem. The keypoint that the category calls "stem", where its visibility is above 0; no other
/// one, whatever the number of keypoints.
///
/// Masks. Polygons by furrow_annotation/polygon.hpp, several of one annotation united; run lengths
/// plain or compressed; without a segmentation the box (box_only). Unlike pycocotools, a list of
/// four numbers is a polygon of two corners, and not a box.
///
/// Crop or weed. What CocoOptions::kinds says of the category's name; else its "supercategory";
/// else its name, if that is "crop" or "weed"; else CocoOptions::unknown_kind.
///
/// "iscrowd" is a region to ignore. Beyond COCO are read: "resolution_mm_per_px" of the file, its
/// "info" or an image; "ignore_boxes", "pose" [x_m, y_m, heading_rad], "velocity_mps", "stamp_ns",
/// "sequence", "labelled" and "depth_file_name" of an image; "area_mm2", "score",
/// "attributes.truncated" and "attributes.mask" ("box": box_only) of an annotation. File names are
/// relative to the annotation file's folder.
namespace furrow::annotation {

enum class UnknownKind {
  kAssumeWeed,  ///< and say so in the report
  kRefuse,      ///< kNotFound, names the categories
};

struct CocoOptions {
  /// A bad annotation is an Error; else it is left out and counted in Dataset::report.
  bool strict = false;
  std::map<std::string, SubClassKind> kinds;
  UnknownKind unknown_kind = UnknownKind::kAssumeWeed;
};

/// Images and categories must be sound; annotations may be left out, see CocoOptions. Errors name
/// the file and the key: kNotFound, kIo, kParse, kOutOfRange (more than a million annotations, or
/// masks of more than 2^31 pixels in all).
[[nodiscard]] Result<Dataset> read_coco(const std::filesystem::path& file,
                                        const CocoOptions& options = {});

/// Writes what read_coco reads, masks as compressed run lengths, so that they come back bit by bit.
/// Image paths become relative to the file's folder where they lie under it. A path that is not
/// UTF-8 is kept as "file_name_percent" beside a readable "file_name". The file is written whole or
/// not at all. Errors: kInvalidArgument (a box or mask beside its image, a category not in the
/// list), kIo.
[[nodiscard]] Status write_coco(const std::filesystem::path& file, const Dataset& dataset);

}  // namespace furrow::annotation
