#pragma once

#include <filesystem>
#include <vector>

#include "furrow_simulation/photo_ground.hpp"

namespace furrow::components {

/// Annotated photographs of a folder that annotation::read_dataset reads: CWFID, Carrot-Weed or
/// COCO. At most `limit`, in the order of the data set. Throws ConfigError with the folder or file.
[[nodiscard]] std::vector<simulation::GroundPhoto> load_ground_photos(
    const std::filesystem::path& folder, int limit);

}  // namespace furrow::components
