#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>

#include "furrow_core/time.hpp"

namespace furrow::components {

/// Says what is wrong with the depth images of a camera. None comes; their stamps are too far from
/// those of the colour images; their distances contradict the mounting of the camera.
class DepthWatch {
 public:
  /// `ground_distance_m`: from the camera to the ground.
  DepthWatch(Duration tolerance, double ground_distance_m)
      : tolerance_(tolerance), ground_distance_m_(ground_distance_m) {}

  void depth_came(Time stamp) { newest_depth_ = stamp; }
  void image_paired() { in_vain_ = 0; }
  void image_in_vain(Time stamp) {
    ++in_vain_;
    last_in_vain_ = stamp;
  }
  /// CV_32FC1, in m; not positive or not finite where unknown.
  void measured(const cv::Mat& depth_m);

  /// After some images in a row without a depth; empty: nothing is wrong.
  [[nodiscard]] std::string missing() const;
  /// Both distances, when they differ by more than a fifth; empty: nothing is wrong.
  [[nodiscard]] std::string contradiction() const;

 private:
  Duration tolerance_;
  double ground_distance_m_;
  std::optional<Time> newest_depth_;
  Time last_in_vain_;
  std::int64_t in_vain_ = 0;  // images in a row
  std::optional<double> median_m_;
};

}  // namespace furrow::components
