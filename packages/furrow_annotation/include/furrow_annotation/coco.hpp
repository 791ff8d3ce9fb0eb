#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "furrow_annotation/dataset.hpp"
#include "furrow_core/result.hpp"

/// COCO instance annotations (Lin et al. 2014), read as pycocotools reads them.
///
/// Coordinates. COCO's polygons and boxes are measured from the upper left CORNER of the image. Its
/// keypoints are pixel indices: measured from the CENTRE of the upper left pixel, as Detectron2
/// reads them. Polygons and boxes become masks; a stem keeps the numbers of the file.
///
/// Stem. The keypoint that the category calls "stem", where its visibility is above 0; no other
/// one, whatever the number of keypoints.
///
/// Masks. Polygons by furrow_annotation/polygon.hpp, several of one annotation united; run lengths
/// plain or compressed; without a segmentation the box (box_only). Unlike pycocotools, a list of
/// four numbers is a polygon of two corners, and not a box.
///
/// Crop or weed. The first of these that says "crop" or "weed": CocoOptions::kinds by the
/// category's name, its "supercategory", its name; else CocoOptions::unknown_kind decides.
///
/// "iscrowd" is a region to ignore. File names are relative to the annotation file's folder.
/// Extensions of the format:
/// - of the file, its "info" or an image: "resolution_mm_per_px";
/// - of an image: "ignore_boxes", "pose" [x_m, y_m, heading_rad], "velocity_mps", "stamp_ns",
///   "sequence", "labelled", "depth_file_name";
/// - of an annotation: "area_mm2", "score", "attributes.truncated", "attributes.mask" ("box":
///   box_only).
namespace furrow::annotation {

enum class UnknownKind {
  kAssumeWeed,  ///< and list them in the report
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

/// Writes a file for read_coco, with masks as compressed run lengths: they read back bit-identical.
/// Image paths below the file's folder become relative to it. A path that is not UTF-8 is also
/// written as "file_name_percent". The file is written whole or not at all. Errors:
/// kInvalidArgument (a box or mask outside its image, an unlisted category), kIo.
[[nodiscard]] Status write_coco(const std::filesystem::path& file, const Dataset& dataset);

}  // namespace furrow::annotation
