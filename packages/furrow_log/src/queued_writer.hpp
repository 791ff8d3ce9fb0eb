#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <semaphore>
#include <thread>
#include <vector>

#include "furrow_log/log.hpp"
#include "priority_mutex.hpp"
#include "sink_list.hpp"

namespace furrow::log {

/// Writes lines to sinks on a dedicated thread, in the order of arrival. The queue is bounded: a
/// line that finds it full is dropped, and the log says how many were. Thread-safe.
class QueuedWriter {
 public:
  static constexpr std::size_t kMaxQueued = 4096;

  /// The sinks outlive it.
  explicit QueuedWriter(SinkList& sinks);
  /// Writes the rest of the queue.
  ~QueuedWriter();
  QueuedWriter(const QueuedWriter&) = delete;
  QueuedWriter& operator=(const QueuedWriter&) = delete;

  /// False: the queue was full. Never waits for a sink.
  bool push(Line line);
  /// On return all lines that were pushed before are written. Not to be called by a sink.
  void wait_until_written();
  [[nodiscard]] std::uint64_t dropped() const;

 private:
  void run();
  void write_all();

  SinkList& sinks_;

  mutable PriorityMutex queue_mutex_;  ///< of queue_ to ending_
  std::vector<Line> queue_;
  std::uint64_t pushed_ = 0;
  std::uint64_t dropped_ = 0;
  bool ending_ = false;
  // Signals without a lock, which a preempted thread could hold.
  std::counting_semaphore<> wake_{0};

  std::mutex written_mutex_;  ///< of written_; no caller of push() takes it
  std::condition_variable written_changed_;
  std::uint64_t written_ = 0;

  // Used by the thread only.
  std::vector<Line> batch_;
  std::uint64_t dropped_told_ = 0;

  std::thread thread_;
};

}  // namespace furrow::log
