#pragma once

#include <thread>

#include "furrow_core/mutex.hpp"
#include "node.hpp"
#include "realtime_clock.hpp"
#include "stop_request.hpp"

namespace furrow::graph {

/// A thread that calls one node. It sleeps until the node's next timer or message.
class DedicatedThread {
 public:
  DedicatedThread(Node& node, const RealtimeClock& clock, const StopRequest& stop)
      : node_(node), clock_(clock), stop_(stop) {}

  /// Starts the thread; it calls the node after release(). Throws std::system_error.
  void start();
  /// @pre The next times of the node's timers are set.
  void release();
  /// The node has messages, or a stop was requested. From any thread.
  void wake();
  void join();

 private:
  void loop();
  void wait_for_release();
  /// Returns at the next timer, or after wake().
  void wait_for_work();
  void set_priority();
  void run_due_timers();

  Node& node_;
  const RealtimeClock& clock_;
  const StopRequest& stop_;
  Mutex mutex_;
  ConditionVariable wake_;
  bool released_ FURROW_GUARDED_BY(mutex_) = false;
  bool woken_ FURROW_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace furrow::graph
