#include "dedicated_thread.hpp"

#include <algorithm>

#include "thread_scheduling.hpp"

namespace furrow::graph {

void DedicatedThread::start() {
  thread_ = std::thread([this] { loop(); });
}

void DedicatedThread::release() {
  {
    const MutexLock lock(mutex_);
    released_ = true;
  }
  wake_.notify_one();
}

void DedicatedThread::wake() {
  {
    const MutexLock lock(mutex_);
    woken_ = true;
  }
  wake_.notify_one();
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

void DedicatedThread::wait_for_release() {
  const MutexLock lock(mutex_);
  while (!released_ && !stop_.requested()) wake_.wait(mutex_);
}

void DedicatedThread::wait_for_work() {
  const auto& timers = node_.timers();
  const auto next = std::ranges::min_element(timers, {}, &Node::Timer::next);
  const MutexLock lock(mutex_);
  while (!woken_ && !stop_.requested()) {
    if (next == timers.end()) {
      wake_.wait(mutex_);
    } else if (!wake_.wait_until(mutex_, clock_.steady(next->next))) {
      break;
    }
  }
  woken_ = false;
}

void DedicatedThread::loop() {
  set_priority();
  wait_for_release();
  while (!stop_.requested()) {
    wait_for_work();
    if (stop_.requested()) return;
    node_.run_messages();
    run_due_timers();
  }
}

}  // namespace furrow::graph
