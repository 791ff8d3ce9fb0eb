#include "send_queue.hpp"

#include <algorithm>
#include <utility>

namespace furrow::dds {

SendQueue::SendQueue(Sender& sender, MessageSink& sink, std::size_t depth)
    : sender_(sender),
      sink_(sink),
      depth_(std::max<std::size_t>(1, depth)),
      thread_(&sender.prompt) {}

// In this order: the prompt thread may pass the queue on to the bulk thread, never back.
SendQueue::~SendQueue() {
  sender_.prompt.remove(*this);
  sender_.bulk.remove(*this);
}

void SendQueue::push(graph::MessagePtr message) {
  graph::MessagePtr oldest;  // freed after the lock: that of an image takes a while
  SendThread* thread = nullptr;
  {
    const MutexLock lock(mutex_);
    if (waiting_.size() == depth_) {
      oldest = std::move(waiting_.front());
      waiting_.pop_front();
      ++counters_.dropped;
    }
    waiting_.push_back(std::move(message));
    if (!std::exchange(scheduled_, true)) thread = thread_;
  }
  if (thread != nullptr) thread->schedule(*this);
}

SendThread* SendQueue::send_oldest() {
  graph::MessagePtr message;
  bool bulk = false;
  {
    const MutexLock lock(mutex_);
    bulk = thread_ == &sender_.bulk;
    if (moved_ != nullptr) {
      message = std::move(moved_);
    } else {
      message = std::move(waiting_.front());
      waiting_.pop_front();
    }
  }
  const std::size_t size = sink_.size(message);
  if (!bulk && size > sender_.bulk_threshold_bytes) {
    const MutexLock lock(mutex_);
    moved_ = std::move(message);
    thread_ = &sender_.bulk;
    return thread_;
  }
  const bool sent = sink_.send(message, size);
  message.reset();
  const MutexLock lock(mutex_);
  if (sent) {
    ++counters_.messages;
    counters_.bytes += size;
  } else {
    ++counters_.dropped;
  }
  scheduled_ = !waiting_.empty();
  if (scheduled_) return thread_;
  idle_.notify_all();
  return nullptr;
}

bool SendQueue::wait_idle(std::chrono::steady_clock::time_point deadline) {
  const MutexLock lock(mutex_);
  while (scheduled_) {
    if (!idle_.wait_until(mutex_, deadline)) return !scheduled_;
  }
  return true;
}

graph::TransportCounters SendQueue::counters() const {
  const MutexLock lock(mutex_);
  return counters_;
}

void SendQueue::count_dropped() {
  const MutexLock lock(mutex_);
  ++counters_.dropped;
}

}  // namespace furrow::dds
