#pragma once

#include <cstddef>
#include <deque>
#include <unordered_map>
#include <vector>

#include "furrow_core/time.hpp"

namespace furrow::graph {

class Node;

/// Which nodes have mail or due timers and wait to be called; a node is called by one thread at a
/// time. Not thread-safe. Nodes are not owned and must outlive the queue.
class StrandQueue {
 public:
  struct DueTimer {
    std::size_t timer;
    Time due;
  };
  struct Call {
    Node* node;
    std::vector<DueTimer> timers;
  };

  void add(Node& node);

  /// A node that is being called is enqueued again at the end of its call. @pre The node was added.
  void enqueue(Node& node);
  /// False, and nothing changes, where an earlier call of the same timer has not begun yet.
  [[nodiscard]] bool enqueue_timer(Node& node, std::size_t timer, Time due);

  [[nodiscard]] bool empty() const { return ready_.empty(); }
  [[nodiscard]] std::size_t size() const { return ready_.size(); }
  /// @pre Not empty, as for begin_first().
  [[nodiscard]] const Node& front() const { return *ready_.front(); }

  /// Takes out the first; the caller calls it, then end().
  [[nodiscard]] Call begin_first();
  /// As begin_first() for a node that has mail and was not enqueued for it; else false, and the
  /// node is enqueued.
  [[nodiscard]] bool begin_or_enqueue(Node& node);
  void end(Node& node);

 private:
  struct Strand {
    bool queued = false;
    bool running = false;
    bool again = false;  // something came while it ran
    std::vector<bool> timer_pending;
    std::vector<DueTimer> due;
  };

  std::unordered_map<const Node*, Strand> strands_;
  std::deque<Node*> ready_;
};

}  // namespace furrow::graph
