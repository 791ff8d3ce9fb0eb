#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/recording_reader.hpp"
#include "furrow_recording/topic_filter.hpp"

namespace furrow::recording {

struct ExportOptions {
  TopicFilter topics;
  double from_s = 0.0;         ///< from the first message of the recording, included
  std::optional<double> to_s;  ///< excluded; none: to the end
};

/// What became of one topic.
struct ExportedTopic {
  std::string name;
  std::string file;            ///< CSV file or folder of images, in the target folder
  std::uint64_t written = 0;   ///< rows, or images
  std::uint64_t left_out = 0;  ///< messages that could not be read
  std::string reason;          ///< why; the first one
};

struct ExportReport {
  std::vector<ExportedTopic> topics;
  std::uint64_t images = 0;
  std::vector<std::string> faults;  ///< of the recording; at most a hundred
  std::string damage;               ///< why the recording is not whole
  std::vector<std::string> unmatched_includes;

  /// Every message of every selected topic is in the output.
  [[nodiscard]] bool complete() const;
};

/// Writes a recording into a new folder, which appears when it is whole. Images
/// (sensor_msgs/Image, CompressedImage) become TOPIC/NUMBER_STAMP.png, listed in frames.json, a
/// COCO file without annotations. All other topics become TOPIC.csv, see CdrTable. Depth in metres
/// becomes 16 bit millimetres. kInvalidArgument when the folder exists or no topic matches; kIo.
[[nodiscard]] Result<ExportReport> export_recording(const RecordingReader& reader,
                                                    const std::filesystem::path& folder,
                                                    const ExportOptions& options);

}  // namespace furrow::recording
