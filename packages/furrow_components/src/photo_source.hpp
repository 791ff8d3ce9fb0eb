#pragma once

#include <filesystem>
#include <vector>

#include "furrow_simulation/photo_ground.hpp"

namespace furrow::components {

/// Annotated photographs of a folder, told apart by its layout: CWFID (annotations/) or Carrot-Weed
/// (plant_masks/). At most `limit`, in the order of their names. Throws ConfigError that names the
/// folder or file.
[[nodiscard]] std::vector<simulation::GroundPhoto> load_ground_photos(
    const std::filesystem::path& folder, int limit);

}  // namespace furrow::components
