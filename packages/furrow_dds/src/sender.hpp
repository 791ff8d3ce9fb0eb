#pragma once

#include <cstddef>
#include <deque>
#include <thread>

#include "furrow_core/mutex.hpp"

namespace furrow::dds {

class SendQueue;

/// A thread that serves queues in turn, one message of each.
class SendThread {
 public:
  /// Throws std::system_error.
  SendThread();
  /// @pre No queue is left.
  ~SendThread();
  SendThread(const SendThread&) = delete;
  SendThread& operator=(const SendThread&) = delete;

  void schedule(SendQueue& queue);
  /// Takes the queue out and returns when the thread does not use it.
  void remove(SendQueue& queue);

 private:
  void run();

  Mutex mutex_;
  ConditionVariable work_;
  ConditionVariable served_;
  std::deque<SendQueue*> ready_ FURROW_GUARDED_BY(mutex_);
  SendQueue* current_ FURROW_GUARDED_BY(mutex_) = nullptr;
  bool stop_ FURROW_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

/// Sends the messages of all queues. Queues with large messages have a second thread, so that an
/// image does not delay a command. A queue belongs to one thread at a time, which keeps its order.
struct Sender {
  explicit Sender(std::size_t threshold_bytes) : bulk_threshold_bytes(threshold_bytes) {}

  const std::size_t bulk_threshold_bytes;
  SendThread prompt;
  SendThread bulk;  ///< for a queue from its first message above the threshold on
};

}  // namespace furrow::dds
