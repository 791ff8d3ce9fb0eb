#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

#include "furrow_core/mutex.hpp"
#include "furrow_core/time.hpp"

namespace furrow::graph {

class Node;

/// The nodes that wait for a worker of the thread pool, in the order in which they became ready.
/// Each node is a serial queue: one worker at a time calls it. Thread-safe. Nodes are not owned and
/// must outlive the queue.
class ReadyQueue {
 public:
  struct DueTimer {
    std::size_t timer;
    Time due;
  };
  struct Call {
    Node* node;
    std::vector<DueTimer> timers;
  };

  /// Before any other call. The node's timers must be known.
  void add(Node& node);

  /// The node has messages. Wakes an idle worker; a node that is being called becomes ready again
  /// at the end of the call. @pre The node was added.
  void push(Node& node);
  /// As push(), for a timer. False without effect while an earlier tick of it still waits.
  [[nodiscard]] bool push_timer(Node& node, std::size_t timer, Time due);

  /// Waits for the next node; the worker calls it, then done(). Empty after close().
  [[nodiscard]] std::optional<Call> pop();
  void done(Node& node);
  /// Ends every pop(), now and later.
  void close();

 private:
  struct Strand {
    bool queued = false;
    bool running = false;
    bool again = false;  ///< something arrived during the call
    std::vector<bool> timer_pending;
    std::vector<DueTimer> due;
  };

  /// True if the node joined the queue.
  bool enqueue(Node& node) FURROW_REQUIRES(mutex_);

  Mutex mutex_;
  ConditionVariable wake_;
  std::unordered_map<const Node*, Strand> strands_ FURROW_GUARDED_BY(mutex_);
  std::deque<Node*> ready_ FURROW_GUARDED_BY(mutex_);
  bool closed_ FURROW_GUARDED_BY(mutex_) = false;
};

}  // namespace furrow::graph
