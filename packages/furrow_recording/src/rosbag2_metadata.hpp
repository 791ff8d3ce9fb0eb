#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::recording {

/// What the metadata.yaml of a rosbag2 folder says. Counts and times in it are not read: those of
/// the files are.
struct Rosbag2Metadata {
  std::vector<std::filesystem::path> files;  ///< in the folder, in their order
  std::string compression_format;            ///< "zstd"; empty: none
  std::string compression_mode;              ///< "file" or "message", lower case
};

/// Parses a metadata.yaml. kParse when it is not one, names a file outside of the folder, or uses a
/// compression other than zstd.
[[nodiscard]] Result<Rosbag2Metadata> parse_rosbag2_metadata(const std::string& yaml);

}  // namespace furrow::recording
