#pragma once

#include <filesystem>
#include <vector>

#include "furrow_recording/recording_reader.hpp"

namespace furrow::recording {

/// Opens one SQLite file of rosbag2. `temporary`: unpacked from a compressed file, and removed once
/// it is open.
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> open_db3(const std::filesystem::path& path,
                                                                const OpenOptions& options,
                                                                bool temporary = false);
/// Opens the bytes of such a file.
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> open_db3(std::vector<std::byte> bytes,
                                                                const OpenOptions& options);

}  // namespace furrow::recording
