#include "send_queue.hpp"

#include <algorithm>
#include <utility>

namespace furrow::dds {

Sender::Sender(std::size_t bulk_threshold_bytes) : bulk_threshold_bytes_(bulk_threshold_bytes) {
  threads_[kPrompt] = std::thread([this] { run(kPrompt); });
  threads_[kBulk] = std::thread([this] { run(kBulk); });
}

Sender::~Sender() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  for (Alarm& work : work_) {
    work.ring_in({});
  }
  for (auto& thread : threads_) {
    thread.join();
  }
}

void Sender::schedule(SendQueue& queue) {
  queue.scheduled_ = true;
  ready_[queue.lane_].push_back(&queue);
  ++waiting_;
}

void Sender::run(Lane lane) {
  std::unique_lock lock(mutex_);
  while (!stop_) {
    if (ready_[lane].empty()) {
      lock.unlock();
      work_[lane].wait();
      lock.lock();
      rung_[lane] = false;
    } else if (send_first_of(lane, lock)) {
      ring({});
    }
  }
}

void Sender::send_one() {
  std::unique_lock lock(mutex_);
  for (const Lane lane : {kPrompt, kBulk}) {
    if (!ready_[lane].empty()) {
      (void)send_first_of(lane, lock);
      return;
    }
  }
}

void Sender::wake_in(std::chrono::nanoseconds delay) {
  const std::lock_guard lock(mutex_);
  ring(delay);
}

void Sender::ring(std::chrono::nanoseconds delay) {
  for (const Lane lane : {kPrompt, kBulk}) {
    // A later ring must not put off an earlier one.
    if (!ready_[lane].empty() && (!rung_[lane] || delay.count() == 0)) {
      rung_[lane] = true;
      work_[lane].ring_in(delay);
    }
  }
}

bool Sender::send_first_of(Lane lane, std::unique_lock<std::mutex>& lock) {
  SendQueue& queue = *ready_[lane].front();
  ready_[lane].pop_front();
  --waiting_;
  graph::MessagePtr message = queue.pop();
  queue.sending_ = true;
  lock.unlock();

  const std::size_t size = queue.sink_.size(message);
  const bool hand_over = lane == kPrompt && size > bulk_threshold_bytes_;
  bool sent = false;
  if (!hand_over) {
    sent = queue.sink_.send(message, size);
    message.reset();
  }

  lock.lock();
  queue.sending_ = false;
  if (hand_over) {
    queue.lane_ = kBulk;
    queue.held_ = std::move(message);
  } else if (sent) {
    ++queue.counters_.messages;
    queue.counters_.bytes += size;
  } else {
    ++queue.counters_.dropped;
  }
  idle_.notify_all();
  if (queue.held_ || queue.count_ > 0) {
    schedule(queue);
  } else {
    queue.scheduled_ = false;
  }
  return hand_over;
}

SendQueue::SendQueue(Sender& sender, MessageSink& sink, std::size_t depth)
    : sender_(sender), sink_(sink), ring_(std::max<std::size_t>(1, depth)) {}

SendQueue::~SendQueue() {
  std::unique_lock lock(sender_.mutex_);
  sender_.idle_.wait(lock, [&] { return !sending_; });
  for (auto& ready : sender_.ready_) {
    sender_.waiting_ -= std::erase(ready, this);
  }
}

void SendQueue::push(graph::MessagePtr message) {
  push_quietly(std::move(message));
  sender_.wake_in({});
}

void SendQueue::push_quietly(graph::MessagePtr message) {
  graph::MessagePtr oldest;  // freed after the lock: that of an image takes a while
  const std::lock_guard lock(sender_.mutex_);
  if (count_ == ring_.size()) {
    oldest = std::exchange(ring_[first_], nullptr);
    first_ = (first_ + 1) % ring_.size();
    --count_;
    ++counters_.dropped;
  }
  ring_[(first_ + count_) % ring_.size()] = std::move(message);
  ++count_;
  if (!scheduled_) {
    sender_.schedule(*this);
  }
}

graph::MessagePtr SendQueue::pop() {
  if (held_) {
    return std::exchange(held_, nullptr);
  }
  graph::MessagePtr message = std::exchange(ring_[first_], nullptr);
  first_ = (first_ + 1) % ring_.size();
  --count_;
  return message;
}

bool SendQueue::wait_idle(std::chrono::steady_clock::time_point deadline) {
  sender_.wake_in({});
  std::unique_lock lock(sender_.mutex_);
  return sender_.idle_.wait_until(lock, deadline, [&] { return !scheduled_; });
}

graph::TransportCounters SendQueue::counters() const {
  const std::lock_guard lock(sender_.mutex_);
  return counters_;
}

void SendQueue::count_dropped() {
  const std::lock_guard lock(sender_.mutex_);
  ++counters_.dropped;
}

}  // namespace furrow::dds
