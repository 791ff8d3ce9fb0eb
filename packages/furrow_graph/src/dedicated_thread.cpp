#include "dedicated_thread.hpp"

#include <algorithm>

#include "thread_scheduling.hpp"

namespace furrow::graph {

void DedicatedThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void DedicatedThread::release() {
  const std::lock_guard lock(mutex_);
  released_ = true;
  wake_.notify_one();
}

void DedicatedThread::wake() {
  {
    const std::lock_guard lock(mutex_);
    woken_ = true;
  }
  wake_.notify_one();  // it would find the mutex taken
}

void DedicatedThread::join() {
  if (thread_.joinable()) thread_.join();
}

void DedicatedThread::set_priority() {
  const int priority = node_.spec().priority;
  if (priority == 0) {
    node_.set_thread("dedicated");
    return;
  }
  touch_stack();
  const std::string refused = use_fifo_scheduling(priority);
  node_.set_thread(refused.empty() ? "dedicated, SCHED_FIFO " + std::to_string(priority)
                                   : "dedicated; SCHED_FIFO refused: " + refused);
}

Time DedicatedThread::next_timer() const {
  return std::ranges::min_element(node_.timers(), {}, &Node::Timer::next)->next;
}

void DedicatedThread::run_due_timers() {
  auto& timers = node_.timers();
  for (std::size_t i = 0; i < timers.size(); ++i) {
    Node::Timer& timer = timers[i];
    const Time now = clock_.now();
    if (timer.next > now) continue;
    for (; timer.next + timer.period <= now; timer.next += timer.period) {
      node_.count_missed_timer();
    }
    const Time due = timer.next;
    timer.next += timer.period;
    node_.run_timer(i, due);
  }
}

void DedicatedThread::loop() {
  set_priority();
  {
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [this] { return released_ || stop_.requested(); });
  }
  const auto wanted = [this] { return woken_ || stop_.requested(); };
  while (!stop_.requested()) {
    {
      std::unique_lock lock(mutex_);
      if (node_.timers().empty()) {
        wake_.wait(lock, wanted);
      } else {
        wake_.wait_until(lock, clock_.steady(next_timer()), wanted);
      }
      woken_ = false;
    }
    if (stop_.requested()) return;
    node_.run_messages();
    run_due_timers();
  }
}

}  // namespace furrow::graph
