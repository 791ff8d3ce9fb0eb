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
#include "furrow_recording/recorder_parameters.hpp"
#include "furrow_recording/topic_description.hpp"

namespace furrow::recording {

using Payload = std::shared_ptr<const std::vector<std::byte>>;

enum class RecorderState : std::uint8_t {
  kArmed,      ///< keeps the last pre_trigger_s in memory, waits for trigger()
  kRecording,  ///< writes
  kPaused,     ///< lets messages go, counted; latched ones are kept
  kStopped,    ///< closed, by stop() or by a fault
};

struct RecordedTopic {
  std::string name;
  std::uint64_t messages = 0;  ///< written, or waiting in the current chunk
  std::uint64_t bytes = 0;     ///< of their payloads
  std::uint64_t dropped = 0;   ///< not written though recording: queue full, refused, disk
};

struct RecorderStatus {
  RecorderState state = RecorderState::kArmed;
  std::string fault;  ///< why it stopped by itself, or the last message was refused
  std::vector<std::filesystem::path> files;
  std::vector<RecordedTopic> topics;  ///< by the numbers that add_topic() gave
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;    ///< of all files
  std::uint64_t dropped = 0;  ///< of all topics
  std::uint64_t paused = 0;   ///< let go while paused
  std::uint64_t expired = 0;  ///< left the pre-trigger window
};

/// What the recorder asks of the machine; replaced in tests.
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
/// closes the file in good order, sets `fault` and state kStopped; more messages are then counted
/// as dropped.
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
  /// A number for the topic; the same name and type give the same. Filters are not asked.
  [[nodiscard]] std::size_t add_topic(const TopicDescription& topic);

  /// Takes a message over. The error is also in status().fault. @pre topic from add_topic().
  Status write(std::size_t topic, Time log_time, Time publish_time, Payload payload);
  /// Counts messages that were lost before they came here.
  void count_dropped(std::size_t topic, std::uint64_t messages);
  /// To be called now and then: writes a chunk that waits longer than flush_s.
  Status tick(Time now);

  /// kArmed: writes what is in memory and goes on recording. Else nothing.
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
