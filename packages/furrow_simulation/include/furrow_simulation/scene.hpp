#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "furrow_field/field_model.hpp"
#include "furrow_geometry/camera.hpp"

namespace furrow::simulation {

/// Ground truth of a plant with at least one visible pixel in a frame.
struct VisiblePlant {
  std::size_t plant_index = 0;  ///< into FieldModel::plants
  std::int64_t id = 0;          ///< Plant::id
  std::int64_t visible_px = 0;
  double area_mm2 = 0.0;  ///< of the whole plant seen from straight above, nothing in front of it
  Eigen::Vector2d stem_px = Eigen::Vector2d::Zero();  ///< may lie outside the image
};

/// A simulated RGB-D image and its ground truth. The matrices have the camera's size and are owned
/// by the frame.
struct Frame {
  cv::Mat bgr;          ///< 8UC3
  cv::Mat depth_m;      ///< 32FC1, along the optical axis; 0 where there is none
  cv::Mat plant_index;  ///< 32SC1, index into FieldModel::plants; -1 where there is no plant
  std::vector<VisiblePlant> plants;  ///< in the order of plant_index
};

/// A scene that a down-facing camera can render.
class Scene {
 public:
  virtual ~Scene() = default;

  [[nodiscard]] virtual const field::FieldModel& field() const = 0;
  /// The picture from a camera whose optical frame C stands at X_FC. The same scene, pose and
  /// `frame_index` give the same bytes, whatever was rendered before; the index seeds the sensor's
  /// noise. Pixels that see no ground (above the horizon, or beyond the scene's range) hold no
  /// depth and no plant. A pose that is not finite gives such pixels only. Not thread-safe.
  [[nodiscard]] virtual Frame render(const geometry::PinholeCamera& camera,
                                     const Eigen::Isometry3d& X_FC, std::uint64_t frame_index) = 0;
};

}  // namespace furrow::simulation
