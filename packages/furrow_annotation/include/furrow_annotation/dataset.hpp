#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "furrow_annotation/read_report.hpp"
#include "furrow_core/time.hpp"
#include "furrow_geometry/pose.hpp"

/// Annotated images in memory, independent of their file format.
///
/// Pixel coordinates: u to the right, v down, (0, 0) at the CENTRE of the upper left pixel. That
/// pixel covers [-0.5, 0.5) in both. The readers convert to this convention.
namespace furrow::annotation {

enum class SubClassKind { kCrop, kWeed };

/// One entry of a class list: a species (or a category) and what it counts as.
struct SubClass {
  std::string name;
  SubClassKind kind = SubClassKind::kWeed;
};

/// The name of a species; empty for "crop" and "weed", which name none.
[[nodiscard]] inline std::string species_of(const SubClass& sub_class) {
  return sub_class.name == "crop" || sub_class.name == "weed" ? "" : sub_class.name;
}

struct AnnotatedInstance {
  SubClassKind kind = SubClassKind::kWeed;
  std::string category;  ///< species, or "crop" / "weed" when unknown
  cv::Rect box_px;       ///< bounding box of the mask, inside the image, not empty
  cv::Mat mask;          ///< CV_8U, size of box_px; 255 plant
  std::optional<Eigen::Vector2d> stem_px;  ///< as annotated; may be outside the image
  std::optional<double> area_mm2;          ///< leaf area of the whole plant from straight above
  std::optional<double> score;             ///< of a detection; none: annotated by hand or known
  bool crowd = false;                      ///< COCO's iscrowd: a region to ignore, not one plant
  bool box_only = false;                   ///< the mask is the annotated box: no outline was drawn
  bool truncated = false;  ///< cut by the image's border: stem and area are of a part
};

struct AnnotatedImage {
  std::filesystem::path path;        ///< of the image
  std::filesystem::path depth_path;  ///< 16-bit PNG in 0.1 mm; empty: none
  cv::Mat bgr;                       ///< CV_8UC3; empty until the user of the data set loads it
  int width_px = 0;
  int height_px = 0;
  std::vector<AnnotatedInstance> instances;
  /// Parts of the image in which nothing counts, neither soil nor plant; inside the image.
  std::vector<cv::Rect> ignore_boxes;
  /// CV_8U of the image's size: 0 soil, else plant, where the data set has a vegetation mask of its
  /// own that is finer than the instances (CWFID). Empty: the union of the instances.
  cv::Mat vegetation;
  std::optional<double>
      resolution_mm_per_px;  ///< ground of a pixel, when the file has it; of the image or of all
  std::optional<geometry::Pose2> X_FB;  ///< robot pose in the field at the exposure
  std::optional<double> velocity_mps;   ///< along the robot's x
  std::optional<Time> stamp;
  std::string sequence;  ///< frames of one short sequence share it; empty: a single image
  bool labelled = true;  ///< false: a frame of a sequence whose last frame carries the labels
};

/// A data set with its class list; images in the order of their file. Pixels are not loaded.
struct Dataset {
  std::string name;
  std::vector<SubClass> classes;
  std::vector<AnnotatedImage> images;
  std::optional<double> resolution_mm_per_px;  ///< of the images without their own
  ReadReport report;                           ///< skipped annotations and assumptions
};

/// Limits of an image's side and area: a corrupt header must not fill the memory.
constexpr int kMaxImageSide_px = 16384;
constexpr int kMaxImageArea_px = 64 * 1024 * 1024;

}  // namespace furrow::annotation
