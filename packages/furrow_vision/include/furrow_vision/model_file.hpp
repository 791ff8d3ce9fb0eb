#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_vision/detector.hpp"

namespace furrow::vision {

/// One network in ONNX, as the model file names it.
struct ModelPart {
  std::string name;            ///< "network"; or "backbone", "box_head", "mask_head"
  std::filesystem::path path;  ///< relative names are resolved by the model file's folder
  std::int64_t bytes = 0;      ///< of the file; 0: not given
  std::string sha256;          ///< of the file, hexadecimal; empty: not given
};

/// Region proposals of a Mask R-CNN: one size of anchors for each level of the pyramid.
struct AnchorLayout {
  std::vector<double> sizes_px;
  std::vector<double> strides_px;
  std::vector<double> aspect_ratios;  ///< height over width
};

/// What stands beside trained networks, as YAML:
///
///   kind: one_stage              # or mask_rcnn; one_stage where it is left out
///   name: ...
///   network: FILE.onnx           # and network_bytes, network_sha256: at least one of the two
///   stride: 4                    # of the output
///   offset_unit_px: 32           # of the offsets to the stem
///   ground_resolution_mm_per_px: 1.15
///   classes: [{name: sugar_beet, kind: crop}, {name: pigweed, kind: weed}]   # crops first
///
/// A mask_rcnn has `backbone`, `box_head` and `mask_head` in place of `network`, and for stride and
/// offset_unit_px `anchors: {sizes_px: [], strides_px: [], aspect_ratios: []}` and feature_levels,
/// and may say `stems: true`. Either may name `crop_log_odds`, added to the log-odds of a crop:
/// what makes up for classes that training weighed differently.
struct ModelFile {
  enum class Kind { kOneStage, kMaskRcnn };
  Kind kind = Kind::kOneStage;
  std::string name;
  std::vector<ModelPart> parts;
  std::vector<SubClass> classes;
  double ground_resolution_mm_per_px = 0.0;
  double crop_log_odds = 0.0;
  std::int64_t stride_px = 0;       ///< one_stage
  double offset_unit_px = 0.0;      ///< one_stage
  AnchorLayout anchors;             ///< mask_rcnn
  std::int64_t feature_levels = 0;  ///< mask_rcnn: from which regions are cut; strides 4, 8, ...
  bool stems = false;               ///< mask_rcnn: the box head tells stems too
};

/// The largest network that is read.
constexpr std::int64_t kMaxNetworkBytes = std::int64_t{256} << 20;

/// Errors name file, line and key: kNotFound, kIo; kParse: not a model file, a key that is missing,
/// not known or out of range.
[[nodiscard]] Result<ModelFile> read_model_file(const std::filesystem::path& path);

/// The bytes of a network. kNotFound, kIo; kParse: not of the size or digest that the model file
/// gives (truncated, or of another model).
[[nodiscard]] Result<std::string> read_model_part(const ModelPart& part);

/// @pre the model has a part of this name, as each that read_model_file() returns has by its kind.
[[nodiscard]] const ModelPart& part_of(const ModelFile& model, const std::string& name);

/// An error when the class list is not `expected`, names in this order. Empty: anything will do.
[[nodiscard]] Status check_classes(const ModelFile& model,
                                   const std::vector<std::string>& expected);

}  // namespace furrow::vision
