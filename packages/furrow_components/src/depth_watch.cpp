#include "depth_watch.hpp"

#include <cmath>

#include "furrow_components/image_conversions.hpp"
#include "furrow_core/text.hpp"

namespace furrow::components {
namespace {

constexpr std::int64_t kInVain = 3;  // one image may lose its depth on the way
constexpr double kContradiction = 0.2;

}  // namespace

void DepthWatch::measured(const cv::Mat& depth_m) {
  median_m_ = median_depth_m(depth_m);
}

std::string DepthWatch::missing() const {
  if (in_vain_ < kInVain) return "";
  const std::string remedy =
      "; perception.use_depth=false takes the ground at perception.ground_distance_m instead";
  const std::string images = std::to_string(in_vain_) + " images in a row have no depth image";
  if (!newest_depth_) return images + ": none was heard" + remedy;
  const double apart_s = std::abs((*newest_depth_ - last_in_vain_).to_seconds());
  return images + " within " + fixed(1e3 * tolerance_.to_seconds(), 0) +
         " ms (perception.depth_tolerance_s): the stamp of the newest differs by " +
         fixed(1e3 * apart_s, 0) + " ms" + remedy;
}

std::string DepthWatch::contradiction() const {
  if (!median_m_) return "";
  if (std::abs(*median_m_ - ground_distance_m_) <= kContradiction * ground_distance_m_) return "";
  return "the depth image says " + fixed(*median_m_, 2) +
         " m to the ground, perception.ground_distance_m " + fixed(ground_distance_m_, 2) +
         " m; for depths of another unit set perception.depth_unit_m";
}

}  // namespace furrow::components
