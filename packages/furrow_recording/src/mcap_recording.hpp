#pragma once

#include "furrow_recording/recording_reader.hpp"

namespace furrow::recording {

[[nodiscard]] Result<std::unique_ptr<RecordingReader>> open_mcap(
    std::unique_ptr<mcap::Source> source, const OpenOptions& options);

}  // namespace furrow::recording
