#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "alarm.hpp"
#include "furrow_graph/transport.hpp"

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

class SendQueue;

/// Two threads that send what waits in queues, one message of each queue in turn; others may help.
/// A queue starts with the first thread and stays with the second from its first message above the
/// threshold on; it is never with both, so that its order holds.
class Sender {
 public:
  explicit Sender(std::size_t bulk_threshold_bytes);
  /// @pre No queue is left.
  ~Sender();
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  /// A message waits that no thread has begun to send.
  [[nodiscard]] bool has_waiting() const { return waiting_ > 0; }
  /// Sends one on the thread that calls, where one waits.
  void send_one();
  /// Has the threads of this object send what waits, when `delay` has passed.
  void wake_in(std::chrono::nanoseconds delay);

 private:
  friend class SendQueue;
  enum Lane : std::size_t { kPrompt, kBulk, kLanes };

  void run(Lane lane);
  // With mutex_ held, which send_first_of() gives back while it sends. It returns true when it left
  // the message to the other thread.
  void schedule(SendQueue& queue);
  void ring(std::chrono::nanoseconds delay);
  bool send_first_of(Lane lane, std::unique_lock<std::mutex>& lock);

  const std::size_t bulk_threshold_bytes_;
  std::mutex mutex_;
  std::array<Alarm, kLanes> work_;
  std::array<bool, kLanes> rung_{};  ///< and not yet heard
  std::condition_variable idle_;
  std::array<std::deque<SendQueue*>, kLanes> ready_;
  std::atomic<std::size_t> waiting_ = 0;  ///< queues in ready_
  bool stop_ = false;
  std::array<std::thread, kLanes> threads_;
};

/// The messages of one writer that wait; the oldest is dropped when `depth` are waiting.
class SendQueue {
 public:
  SendQueue(Sender& sender, MessageSink& sink, std::size_t depth);
  /// Drops what still waits and returns when nothing is being sent.
  ~SendQueue();
  SendQueue(const SendQueue&) = delete;
  SendQueue& operator=(const SendQueue&) = delete;

  void push(graph::MessagePtr message);
  /// No thread is woken: Sender::send_one() or wake_in() must follow.
  void push_quietly(graph::MessagePtr message);
  /// False when something still waits or is being sent at `deadline`.
  [[nodiscard]] bool wait_idle(std::chrono::steady_clock::time_point deadline);
  [[nodiscard]] graph::TransportCounters counters() const;
  void count_dropped();

 private:
  friend class Sender;
  [[nodiscard]] graph::MessagePtr pop();

  Sender& sender_;
  MessageSink& sink_;
  // All below are guarded by sender_.mutex_.
  std::vector<graph::MessagePtr> ring_;
  std::size_t first_ = 0;
  std::size_t count_ = 0;
  graph::MessagePtr held_;  // handed from the first thread to the second
  Sender::Lane lane_ = Sender::kPrompt;
  bool scheduled_ = false;  // in a ready list, or being sent
  bool sending_ = false;
  graph::TransportCounters counters_;
};

}  // namespace furrow::dds
