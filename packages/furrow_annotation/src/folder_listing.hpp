#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::annotation {

/// Files of a folder with this extension (lower case, with dot; any case in the folder), in the
/// order of names. kNotFound when the folder cannot be read.
[[nodiscard]] Result<std::vector<std::filesystem::path>> list_files(
    const std::filesystem::path& folder, const std::string& extension);

}  // namespace furrow::annotation
