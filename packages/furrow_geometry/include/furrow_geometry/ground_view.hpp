#pragma once

#include "furrow_geometry/tool_model.hpp"

namespace furrow::geometry {

/// The least x in the base frame B at which a camera sees the ground plane z = 0: what stands
/// behind it has left the image. 0 when no corner of the image sees the ground.
[[nodiscard]] double rear_view_x_m(const CameraModel& camera);

}  // namespace furrow::geometry
