#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "furrow_msgs/message_type.hpp"
#include "furrow_recording/recorder.hpp"

namespace furrow::recording {

/// The clock of the messages' times.
enum class RecorderClock : std::uint8_t {
  /// A chunk is written after flush_s, also when no message follows. A full queue drops messages.
  kReal,
  /// Chunks end by the messages alone, so that the same messages give the same bytes however long
  /// a simulated step takes. A full queue makes record() wait, and nothing is lost.
  kSimulated,
};

/// A Recorder on a dedicated thread, behind a queue bounded in bytes and messages. Functions are
/// thread-safe. record() neither copies nor serializes, and waits in simulated time only.
class RecorderThread {
 public:
  RecorderThread(const RecorderParameters& parameters, std::filesystem::path stem,
                 RecorderClock clock = RecorderClock::kReal,
                 RecorderEnvironment environment = RecorderEnvironment::of_this_machine());
  /// Writes the queue and closes the file.
  ~RecorderThread();

  [[nodiscard]] bool accepts(const std::string& topic) const;
  [[nodiscard]] std::size_t add_topic(const TopicDescription& topic);

  /// A message in CDR form. False when the queue was full: dropped and counted.
  bool record(std::size_t topic, Time log_time, Time publish_time, Payload payload);
  /// A message as components of one process share it; the recorder's thread serializes it. It must
  /// not change any more.
  bool record(std::size_t topic, Time log_time, Time publish_time,
              std::shared_ptr<const void> message, const msgs::MessageType& type);

  void trigger();
  void pause();
  void resume();
  /// Writes the queue and closes the file.
  Status stop();
  /// Waits until every earlier call has reached the recorder.
  void drain();
  [[nodiscard]] RecorderStatus status() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::recording
