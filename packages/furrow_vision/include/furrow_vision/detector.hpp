#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "furrow_annotation/dataset.hpp"
#include "furrow_core/result.hpp"
#include "furrow_geometry/camera.hpp"

namespace furrow::vision {

using annotation::kMaxImageArea_px;
using annotation::kMaxImageSide_px;
using annotation::SubClass;
using annotation::SubClassKind;

/// One plant seen in one image. Pixels are those of the image given, (0, 0) the centre of the upper
/// left one.
struct Instance {
  double score = 0.0;  ///< super-class: probability that this is a plant and not background
  /// Probability of each entry of Detector::classes(), given that it is a plant; sums to 1.
  std::vector<double> class_scores;
  /// Probability that a stem is seen at stem_px; 0 where the detector does not say.
  double stem_score = 0.0;
  double crop_probability = 0.0;  ///< sum of class_scores over the crop classes
  cv::Rect box_px;                ///< inside the image
  cv::Mat mask;                   ///< CV_8U, size of box_px; 255 plant, 0 else
  Eigen::Vector2d stem_px = Eigen::Vector2d::Zero();
  double stem_depth_m = 0.0;    ///< along the optical axis; the fallback where depth says nothing
  bool depth_measured = false;  ///< false: stem_depth_m and area_mm2 rest on the fallback distance
  double area_mm2 = 0.0;        ///< sum of pixel areas over the mask (Halstead et al. 2021)
  double radius_m = 0.0;        ///< from the stem to the farthest mask pixel, at stem_depth_m
  bool touches_border = false;  ///< cut off by the image's border: stem and area are of a part

  [[nodiscard]] double weed_probability() const { return 1.0 - crop_probability; }
};

/// One registered RGB-D image, borrowed for the call.
struct RgbdView {
  /// CV_8UC3 in BGR order. Grey images and 16-bit ones are an Error; convert before.
  const cv::Mat& bgr;
  /// CV_32FC1 in metres along the optical axis, registered to `bgr`. Empty: ground_distance_m is
  /// used everywhere. Holes are 0, negative or not finite. Another size or type is an Error.
  const cv::Mat& depth_m;
  const geometry::PinholeCamera& camera;
  double ground_distance_m = 1.0;  ///< from the optical centre to the ground, along the axis
  /// Rows of crop as image columns (at the ground), where the caller knows them, so that the
  /// detector need not find them. Empty: the detector's own estimate.
  std::vector<double> crop_row_u_px = {};

  /// Ground resolution at ground_distance_m.
  [[nodiscard]] double ground_mm_per_px() const {
    return 1000.0 * ground_distance_m / camera.intrinsics().fx_px;
  }
};

/// Finds plants in one image. May keep a state over frames (documented by each), so that calls are
/// made in the order of time and never at once from two threads.
class Detector {
 public:
  virtual ~Detector() = default;
  /// kInvalidArgument: image, depth or camera of a type or size that the view does not allow.
  /// An image without plants is an empty list, no Error.
  [[nodiscard]] virtual Result<std::vector<Instance>> detect(const RgbdView& view) = 0;
  /// What class_scores refer to; the same over the detector's life.
  [[nodiscard]] virtual const std::vector<SubClass>& classes() const = 0;
  /// Forgets what was kept from earlier frames.
  virtual void reset() {}
};

/// What each detector asks of a view before it looks at a pixel.
[[nodiscard]] Status check_view(const RgbdView& view);

/// Sum of class_scores over the crop classes. @pre sizes agree.
[[nodiscard]] double crop_probability(const std::vector<double>& class_scores,
                                      const std::vector<SubClass>& classes);

/// Adds to the log-odds of the crop classes together; the scores still sum to 1.
void shift_towards_crops(double log_odds, const std::vector<SubClass>& classes,
                         std::vector<double>& class_scores);

/// Sets stem_depth_m, depth_measured, area_mm2, radius_m and touches_border from box, mask and
/// stem. Holes in the depth take the median depth of the mask's pixels that have one; when fewer
/// than a tenth have one, ground_distance_m.
void measure_instance(const RgbdView& view, Instance& instance);

/// Moves a stem from the middle of its canopy to the ground below. Leaves are nearer to the camera,
/// so that they appear farther from the image's centre than the foot of the stem. Sets stem_px and
/// stem_depth_m (of the ground). The ground's depth is that of the soil around the box, the
/// canopy's that of the mask. Nothing changes without depth in either, or where the canopy is not
/// above the ground. @pre vegetation is CV_8U of the image's size, not zero where plants are.
void place_stem_on_ground(const RgbdView& view, const cv::Mat& vegetation, Instance& instance);

/// Sets stem_depth_m of a stem that was found on the ground to the depth of the soil around the
/// box. Nothing changes without depth there. @pre as place_stem_on_ground.
void set_stem_depth_to_ground(const RgbdView& view, const cv::Mat& vegetation, Instance& instance);

}  // namespace furrow::vision
