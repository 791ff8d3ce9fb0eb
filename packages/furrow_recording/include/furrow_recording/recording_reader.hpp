#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_recording/byte_stream.hpp"
#include "furrow_recording/mcap_reader.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::recording {

/// What a recording holds, in the terms of MCAP whatever its format.
struct RecordingInfo {
  std::string format;  ///< "mcap", "rosbag1" (.bag), "rosbag2" (a folder or .db3 file)
  std::string profile;
  std::string library;  ///< that wrote it; empty: unknown
  std::uint64_t bytes = 0;
  std::set<std::string> compressions;  ///< of its chunks or messages; "none" for none
  /// As counted in the recording; `statistics` is set. A channel is a topic, or one publisher of
  /// it where the recording tells them apart.
  mcap::Summary summary;
  std::string damage;               ///< why the recording is not whole; empty when it is
  std::uint64_t bytes_ignored = 0;  ///< at the end, of no whole record
  std::vector<std::string> faults;  ///< what could not be read at opening; at most a hundred
  /// What its messages lose or gain in the form in which they are read, without being a fault.
  std::vector<std::string> notes;

  [[nodiscard]] const mcap::Statistics& statistics() const { return *summary.statistics; }
  [[nodiscard]] bool whole() const { return damage.empty() && faults.empty(); }
};

/// The messages of a recording, one after the other.
class MessageStream {
 public:
  virtual ~MessageStream() = default;
  /// The next message, or none at the end. Its data live until the next call. After an error
  /// reading may go on, except after kIo: only what could not be read is left out.
  [[nodiscard]] virtual Result<std::optional<mcap::Message>> next() = 0;
};

/// Reads one recording, whatever its format. ROS 1 messages appear in their ROS 2 form: CDR, with
/// ROS 2 type names and schemas. Not thread-safe.
class RecordingReader {
 public:
  virtual ~RecordingReader() = default;
  [[nodiscard]] virtual const RecordingInfo& info() const = 0;
  /// Messages in the order of their log time. The stream must not outlive the reader.
  [[nodiscard]] virtual std::unique_ptr<MessageStream> messages(
      const mcap::ReadOptions& options) const = 0;
  /// By its number in `info().summary.attachments`.
  [[nodiscard]] virtual Result<mcap::Attachment> attachment(std::size_t number) const = 0;
  /// By its number in `info().summary.metadata`.
  [[nodiscard]] virtual Result<mcap::Metadata> metadata(std::size_t number) const = 0;
};

struct OpenOptions {
  mcap::ReaderLimits limits;
  /// Reads and checks every byte at opening, to recover what a damaged file still has.
  bool scan = false;
};

/// Opens an MCAP file, a ROS 1 .bag file, a ROS 2 .db3 file or a rosbag2 folder, by its content and
/// not by its name. Errors name the path. kNotFound, kIo; kParse when it is none of these.
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> open_recording(
    const std::filesystem::path& path, const OpenOptions& options = {});
/// Opens the bytes of an MCAP or .bag file.
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> open_recording(
    std::unique_ptr<mcap::Source> source, const OpenOptions& options = {});
/// Opens one recording, or several as one.
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> open_recordings(
    const std::vector<std::filesystem::path>& paths, const OpenOptions& options = {});

/// Several recordings of one clock as one, in the order of time. Equal channels become one.
/// kInvalidArgument when there is no reader, kOutOfRange above 65535 channels or schemas.
[[nodiscard]] Result<std::unique_ptr<RecordingReader>> merge_readers(
    std::vector<std::unique_ptr<RecordingReader>> readers);

}  // namespace furrow::recording
