#pragma once

#include "furrow_recording/recording_reader.hpp"

namespace furrow::recording {

/// Opens a ROS 1 bag.
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> open_bag(
    std::unique_ptr<mcap::Source> source, const OpenOptions& options);

}  // namespace furrow::recording
