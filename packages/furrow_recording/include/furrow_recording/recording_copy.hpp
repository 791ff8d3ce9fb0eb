#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/mcap_writer.hpp"
#include "furrow_recording/recording_reader.hpp"
#include "furrow_recording/topic_filter.hpp"

namespace furrow::recording {

/// Which messages are copied. Metadata and attachments always are.
struct Selection {
  TopicFilter topics;
  double from_s = 0.0;         ///< from the first message of the recording, included
  std::optional<double> to_s;  ///< excluded; none: to the end
  /// Begin with the latched messages that hold at `from_s`, with that time as their log time.
  bool latched = true;
  double max_hz = 0.0;  ///< of each channel, by log time; latched ones are never left out. 0: all
};

struct CopyReport {
  std::uint64_t messages = 0;
  std::uint64_t messages_in = 0;  ///< of the input, by its own count
  std::uint64_t latched = 0;      ///< of `messages`, repeated from before `from_s`
  std::uint64_t attachments = 0;
  std::uint64_t metadata = 0;
  std::uint64_t bytes_ignored = 0;              ///< of the input's end
  std::string damage;                           ///< why the input is not whole
  std::vector<std::string> faults;              ///< what was left out and why; at most a hundred
  std::vector<std::string> notes;               ///< of the input's format, without being faults
  std::vector<std::string> unmatched_includes;  ///< patterns that match no topic
  std::vector<std::string> unmatched_excludes;

  /// Everything that was asked for is in the output.
  [[nodiscard]] bool complete() const {
    return faults.empty() && damage.empty() && unmatched_includes.empty() && bytes_ignored == 0;
  }
};

/// Copies a recording into a writer, which stays open. kInvalidArgument for a range outside of the
/// recording, and for patterns that match no topic at all.
[[nodiscard]] Result<CopyReport> copy_recording(const RecordingReader& reader, mcap::Writer& writer,
                                                const Selection& selection);

struct CopyJob {
  std::vector<std::filesystem::path> inputs;  ///< of any format; several are merged by time
  std::filesystem::path output;               ///< an MCAP file that does not exist
  Selection selection;
  mcap::WriterOptions writer;  ///< its profile is the input's
  OpenOptions open;
};

/// Copies recordings to a new file, which appears when it is whole. kInvalidArgument when the
/// output exists, kIo when it cannot be written; else as open_recording() and copy_recording().
[[nodiscard]] Result<CopyReport> run_copy(const CopyJob& job);

}  // namespace furrow::recording
