#include "rosbag2_metadata.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

namespace furrow::recording {
namespace {

constexpr std::size_t kMaxMetadataBytes = 16u << 20;

Error not_metadata(const std::string& why) {
  return {ErrorCode::kParse, "metadata.yaml: " + why};
}

}  // namespace

Result<Rosbag2Metadata> parse_rosbag2_metadata(const std::string& yaml) {
  if (yaml.size() > kMaxMetadataBytes) {
    return not_metadata("larger than 16 MiB");
  }
  try {
    const YAML::Node root = YAML::Load(yaml);
    const YAML::Node info = root.IsMap() ? root["rosbag2_bagfile_information"] : YAML::Node();
    if (!info || !info.IsMap()) {
      return not_metadata("has no 'rosbag2_bagfile_information'");
    }
    Rosbag2Metadata metadata;
    const YAML::Node files = info["relative_file_paths"];
    if (!files || !files.IsSequence()) {
      return not_metadata("has no list 'relative_file_paths'");
    }
    for (const YAML::Node& node : files) {
      const auto path = std::filesystem::path(node.as<std::string>()).lexically_normal();
      if (path.empty() || path.is_absolute() || path.begin()->string() == "..") {
        return not_metadata("'" + path.string() + "' is not inside of the folder");
      }
      metadata.files.push_back(path);
    }
    metadata.compression_format = info["compression_format"].as<std::string>("");
    metadata.compression_mode = info["compression_mode"].as<std::string>("");
    std::ranges::transform(metadata.compression_mode, metadata.compression_mode.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!metadata.compression_format.empty() && metadata.compression_format != "zstd") {
      return not_metadata("compression '" + metadata.compression_format +
                          "' is not supported; only zstd is");
    }
    return metadata;
  } catch (const YAML::Exception& failure) {
    return not_metadata(failure.what());
  }
}

}  // namespace furrow::recording
