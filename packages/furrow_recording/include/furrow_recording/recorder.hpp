#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_core/time.hpp"
#include "furrow_recording/byte_stream.hpp"
#include "furrow_recording/payload.hpp"
#include "furrow_recording/recorder_parameters.hpp"
#include "furrow_recording/topic_description.hpp"

namespace furrow::recording {

enum class RecorderState : std::uint8_t {
  kArmed,      ///< keeps the last pre_trigger_s in memory, waits for trigger()
  kRecording,  ///< writes
  kPaused,     ///< counts messages and keeps the latched ones only
  kStopped,    ///< closed, by stop() or by a fault
};

struct RecordedTopic {
  std::string name;
  std::uint64_t messages = 0;  ///< written, or waiting in the current chunk
  std::uint64_t bytes = 0;     ///< of their payloads
  std::uint64_t dropped = 0;   ///< lost while recording: full queue, refused message, full disk
};

struct RecorderStatus {
  RecorderState state = RecorderState::kArmed;
  std::string fault;  ///< why it stopped by itself, or refused its last message
  std::vector<std::filesystem::path> files;
  std::vector<RecordedTopic> topics;  ///< by the numbers of add_topic()
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;    ///< of all files
  std::uint64_t dropped = 0;  ///< of all topics
  std::uint64_t paused = 0;   ///< arrived while paused
  std::uint64_t expired = 0;  ///< left the pre-trigger window
};

/// The recorder's access to the machine; replaced in tests.
struct RecorderEnvironment {
  std::function<Result<std::unique_ptr<mcap::Sink>>(const std::filesystem::path&)> create_file;
  /// Bytes that may still be written beside this path.
  std::function<Result<std::uint64_t>(const std::filesystem::path&)> free_bytes;

  [[nodiscard]] static RecorderEnvironment of_this_machine();
};

/// The logic of recording, on any clock: times are arguments and come from the messages. Not
/// thread-safe; see RecorderThread.
///
/// Files are STEM_0.mcap, STEM_1.mcap, ... A full disk (less than min_free_mb) or a failed write
/// closes the file in good order and sets `fault` and state kStopped. Later messages count as
/// dropped.
class Recorder {
 public:
  /// `stem`: path of the files without number and extension; its folder is made. Throws ConfigError
  /// for a folder that cannot be made or an existing STEM_0.mcap.
  Recorder(const RecorderParameters& parameters, std::filesystem::path stem,
           RecorderEnvironment environment = RecorderEnvironment::of_this_machine());
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  [[nodiscard]] bool accepts(const std::string& topic) const;
  /// The topic's number: equal for equal name, type and publisher. Filters do not apply.
  [[nodiscard]] std::size_t add_topic(const TopicDescription& topic);

  /// Records a message. The error is also in status().fault. @pre topic from add_topic().
  Status write(std::size_t topic, Time log_time, Time publish_time, Payload payload);
  /// Counts messages that were lost before this call.
  void count_dropped(std::size_t topic, std::uint64_t messages);
  /// Writes a chunk that waits for longer than flush_s. Call it regularly.
  Status tick(Time now);

  /// kArmed: writes the messages in memory and records from now on. Otherwise does nothing.
  Status trigger();
  void pause();
  void resume();
  /// Closes the file. Nothing can be recorded afterwards.
  Status stop();

  [[nodiscard]] RecorderStatus status() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::recording
