#pragma once

#include <chrono>
#include <cstddef>
#include <deque>

#include "furrow_core/mutex.hpp"
#include "furrow_graph/transport.hpp"
#include "sender.hpp"

namespace furrow::dds {

/// Where a queue's messages go. Called by one thread at a time.
class MessageSink {
 public:
  virtual ~MessageSink() = default;
  /// Bytes of the serialized message.
  [[nodiscard]] virtual std::size_t size(const graph::MessagePtr& message) = 0;
  /// May block; false when the message could not be sent.
  [[nodiscard]] virtual bool send(const graph::MessagePtr& message, std::size_t size) = 0;
};

/// The messages of one writer that wait to be sent. A full queue drops its oldest message, counted.
/// Thread-safe.
class SendQueue {
 public:
  /// The sender and the sink must outlive the queue; `depth` is at least 1.
  SendQueue(Sender& sender, MessageSink& sink, std::size_t depth);
  /// Drops the waiting messages and returns when none is being sent.
  ~SendQueue();
  SendQueue(const SendQueue&) = delete;
  SendQueue& operator=(const SendQueue&) = delete;

  /// Wakes the sender. Never blocks.
  void push(graph::MessagePtr message);
  /// False if a message still waits or is being sent at `deadline`.
  [[nodiscard]] bool wait_idle(std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] graph::TransportCounters counters() const;
  void count_dropped();

 private:
  friend class SendThread;
  /// Sends the oldest message. Returns the thread that must serve the queue next; null: none waits.
  [[nodiscard]] SendThread* send_oldest();

  Sender& sender_;
  MessageSink& sink_;
  const std::size_t depth_;
  mutable Mutex mutex_;
  ConditionVariable idle_;
  std::deque<graph::MessagePtr> waiting_ FURROW_GUARDED_BY(mutex_);
  /// The first large message, on its way from the prompt thread to the bulk thread.
  graph::MessagePtr moved_ FURROW_GUARDED_BY(mutex_);
  SendThread* thread_ FURROW_GUARDED_BY(mutex_);      ///< the prompt or the bulk thread
  bool scheduled_ FURROW_GUARDED_BY(mutex_) = false;  ///< with the thread, or being sent
  graph::TransportCounters counters_ FURROW_GUARDED_BY(mutex_);
};

}  // namespace furrow::dds
