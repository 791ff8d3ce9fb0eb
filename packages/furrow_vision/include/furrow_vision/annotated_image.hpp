#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_geometry/pose.hpp"
#include "furrow_vision/detector.hpp"

namespace furrow::vision {

struct AnnotatedInstance {
  SubClassKind kind = SubClassKind::kWeed;
  std::string category;  ///< species, or "crop" / "weed" where the data set says no more
  cv::Rect box_px;       ///< inside the image, not empty
  cv::Mat mask;          ///< CV_8U, size of box_px; 255 plant
  std::optional<Eigen::Vector2d> stem_px;
  std::optional<double> area_mm2;  ///< leaf area of the whole plant from straight above
  std::optional<double> score;     ///< of a detection; none: annotated by hand or known
  bool crowd = false;              ///< COCO's iscrowd: a region, not one plant
};

struct AnnotatedImage {
  std::filesystem::path path;        ///< of the image
  std::filesystem::path depth_path;  ///< 16-bit PNG in 0.1 mm; empty: none
  cv::Mat bgr;                       ///< CV_8UC3; empty until load_pixels()
  int width_px = 0;
  int height_px = 0;
  std::vector<AnnotatedInstance> instances;
  /// CV_8U of the image's size: 0 soil, else plant, where the data set has a vegetation mask of its
  /// own that is finer than the instances (CWFID). Empty: the union of the instances.
  cv::Mat vegetation;
  std::optional<geometry::Pose2> X_FB;  ///< robot pose in the field at the exposure
  std::optional<double> velocity_mps;   ///< along the robot's x
  std::optional<Time> stamp;
  std::string sequence;  ///< frames of one short sequence share it; empty: a single image
  bool labelled = true;  ///< false: a frame of a sequence whose last frame carries the labels
};

/// A data set in the order of its files' names, with a class list. Images are read when asked for.
struct Dataset {
  std::string name;
  std::vector<SubClass> classes;
  std::vector<AnnotatedImage> images;
};

/// Reads the pixels, turned as the file's EXIF orientation says (Carrot-Weed's masks are drawn on
/// the turned images). Error: not there, not an image, or not of the size that the annotation
/// names.
[[nodiscard]] Status load_pixels(AnnotatedImage& image);

/// Semantic labels, CV_8U: 0 soil, 1 weed, 2 crop; where instances overlap the later one counts.
[[nodiscard]] cv::Mat semantic_labels(const AnnotatedImage& image);

}  // namespace furrow::vision
