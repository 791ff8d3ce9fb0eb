#include "ready_queue.hpp"

#include <utility>

#include "node.hpp"

namespace furrow::graph {

void ReadyQueue::add(Node& node) {
  const MutexLock lock(mutex_);
  strands_[&node].timer_pending.assign(node.timers().size(), false);
}

void ReadyQueue::push(Node& node) {
  MutexLock lock(mutex_);
  const bool joined = enqueue(node);
  lock.unlock();  // the woken worker would wait for the mutex
  if (joined) wake_.notify_one();
}

bool ReadyQueue::push_timer(Node& node, std::size_t timer, Time due) {
  MutexLock lock(mutex_);
  Strand& strand = strands_.at(&node);
  if (strand.timer_pending[timer]) return false;
  strand.timer_pending[timer] = true;
  strand.due.push_back({timer, due});
  const bool joined = enqueue(node);
  lock.unlock();
  if (joined) wake_.notify_one();
  return true;
}

std::optional<ReadyQueue::Call> ReadyQueue::pop() {
  const MutexLock lock(mutex_);
  while (ready_.empty() && !closed_) wake_.wait(mutex_);
  if (closed_) return std::nullopt;
  Node& node = *ready_.front();
  ready_.pop_front();
  Strand& strand = strands_.at(&node);
  strand.queued = false;
  strand.running = true;
  strand.again = false;
  Call call{&node, std::exchange(strand.due, {})};
  for (const DueTimer& timer : call.timers) strand.timer_pending[timer.timer] = false;
  return call;
}

// The worker that calls done() goes on with pop(): no other one needs to wake.
void ReadyQueue::done(Node& node) {
  const MutexLock lock(mutex_);
  Strand& strand = strands_.at(&node);
  strand.running = false;
  if (strand.again) enqueue(node);
}

void ReadyQueue::close() {
  {
    const MutexLock lock(mutex_);
    closed_ = true;
  }
  wake_.notify_all();
}

bool ReadyQueue::enqueue(Node& node) {
  Strand& strand = strands_.at(&node);
  if (strand.running) {
    strand.again = true;
    return false;
  }
  if (strand.queued) return false;
  strand.queued = true;
  ready_.push_back(&node);
  return true;
}

}  // namespace furrow::graph
