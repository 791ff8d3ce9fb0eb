#pragma once

#include <opencv2/core/mat.hpp>

#include "furrow_core/result.hpp"
#include "furrow_geometry/camera.hpp"
#include "furrow_geometry/distortion.hpp"

namespace furrow::vision {

/// Resamples images of a lens with distortion to those of the pinhole camera with the same
/// intrinsics, so that whatever follows needs no distortion. Without distortion images pass as they
/// are, without a copy.
class Rectifier {
 public:
  /// All coefficients are zero, or the model is empty: no distortion. Errors: kInvalidArgument for
  /// a model of another name, a wrong number of coefficients, values that are not finite, and a
  /// camera larger than an image may be.
  [[nodiscard]] static Result<Rectifier> make(const geometry::CameraIntrinsics& intrinsics,
                                              const geometry::Distortion& distortion);

  [[nodiscard]] bool identity() const { return map_x_.empty(); }
  /// Interpolated between pixels; black where the lens saw nothing.
  /// @pre The size is that of the intrinsics.
  [[nodiscard]] cv::Mat colour(const cv::Mat& image) const;
  /// The nearest pixel's, so that no depth between two objects is invented; 0, which means unknown,
  /// where the lens saw nothing. @pre as colour().
  [[nodiscard]] cv::Mat depth(const cv::Mat& image) const;

 private:
  Rectifier() = default;

  cv::Mat map_x_;  // for each pixel of the pinhole camera, where the lens shows it, px
  cv::Mat map_y_;
};

}  // namespace furrow::vision
