#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "executor.hpp"
#include "node.hpp"
#include "realtime_clock.hpp"

namespace furrow::graph {

/// Calls one node from a thread of its own, which sleeps until the node's next timer or message.
class DedicatedThread {
 public:
  DedicatedThread(Node& node, const RealtimeClock& clock, const StopRequest& stop)
      : node_(node), clock_(clock), stop_(stop) {}

  /// Makes the thread; it calls nothing before release().
  void start();
  /// The timers' next times must be set.
  void release();
  /// Something came for the node, or the stop was requested. From any thread.
  void wake();
  void join();

 private:
  void loop();
  void set_priority();
  [[nodiscard]] Time next_timer() const;
  void run_due_timers();

  Node& node_;
  const RealtimeClock& clock_;
  const StopRequest& stop_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool released_ = false;
  bool woken_ = false;
  std::thread thread_;
};

}  // namespace furrow::graph
