#pragma once

#include <atomic>
#include <mutex>
#include <utility>
#include <vector>

#include "node.hpp"

namespace furrow::graph {

/// What callbacks published for readers outside, until somebody hands it to the transport, in
/// order. To put a message here costs a tenth of what it costs there. Thread-safe.
class Outbox {
 public:
  /// @pre The route has a writer.
  void put(Route& route, MessagePtr message);
  [[nodiscard]] bool empty() const { return size_ == 0; }
  void hand_over();

 private:
  /// Of a callback that publishes without end; the transport's queues are bounded.
  static constexpr std::size_t kMost = 64;
  void hand_over_locked();

  std::mutex mutex_;
  std::vector<std::pair<Route*, MessagePtr>> messages_;
  std::atomic<std::size_t> size_ = 0;
};

}  // namespace furrow::graph
