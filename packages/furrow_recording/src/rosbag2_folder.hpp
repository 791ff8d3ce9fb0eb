#pragma once

#include "furrow_recording/recording_reader.hpp"

namespace furrow::recording {

/// Opens a rosbag2 folder: the files of its metadata.yaml, or without one all .db3 and .mcap files
/// in it, also compressed ones (.zstd).
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> open_rosbag2_folder(
    const std::filesystem::path& folder, const OpenOptions& options);

}  // namespace furrow::recording
