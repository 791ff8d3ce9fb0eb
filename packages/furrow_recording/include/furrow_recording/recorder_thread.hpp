#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "furrow_msgs/message_type.hpp"
#include "furrow_recording/recorder.hpp"

namespace furrow::recording {

/// A Recorder on a dedicated thread, behind a queue bounded in bytes and messages. Functions are
/// thread-safe. record() never copies, serializes or waits; only record_all() waits for the disk.
class RecorderThread {
 public:
  RecorderThread(const RecorderParameters& parameters, std::filesystem::path stem,
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

  /// As record(), but waits for room in a full queue: for runs in simulated time.
  void record_all(std::size_t topic, Time log_time, Time publish_time,
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
