#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "furrow_msgs/message_type.hpp"
#include "furrow_recording/recorder.hpp"

namespace furrow::recording {

/// A Recorder on a thread of its own, behind a queue bounded in bytes and messages. Functions are
/// thread-safe; the record() ones never copy or serialize, and only record_all() waits for the
/// disk.
class RecorderThread {
 public:
  RecorderThread(const RecorderParameters& parameters, std::filesystem::path stem,
                 RecorderEnvironment environment = RecorderEnvironment::of_this_machine());
  /// Writes what waits, and closes the file.
  ~RecorderThread();

  [[nodiscard]] bool accepts(const std::string& topic) const;
  [[nodiscard]] std::size_t add_topic(const TopicDescription& topic);

  /// A message in CDR form. False when the queue was full: dropped and counted.
  bool record(std::size_t topic, Time log_time, Time publish_time, Payload payload);
  /// A message as components of one process hand it around; serialized on the recorder's thread.
  /// Nobody may change it any more.
  bool record(std::size_t topic, Time log_time, Time publish_time,
              std::shared_ptr<const void> message, const msgs::MessageType& type);

  /// As record(), but where the queue is full it waits for room: for runs in simulated time.
  void record_all(std::size_t topic, Time log_time, Time publish_time,
                  std::shared_ptr<const void> message, const msgs::MessageType& type);

  void trigger();
  void pause();
  void resume();
  /// Writes what waits and closes the file.
  Status stop();
  /// Waits until all that was handed over before is in the recorder.
  void drain();
  [[nodiscard]] RecorderStatus status() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::recording
