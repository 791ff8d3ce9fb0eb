#include "outbox.hpp"

namespace furrow::graph {

void Outbox::put(Route& route, MessagePtr message) {
  const std::lock_guard lock(mutex_);
  messages_.emplace_back(&route, std::move(message));
  size_ = messages_.size();
  if (messages_.size() == kMost) hand_over_locked();
}

void Outbox::hand_over() {
  const std::lock_guard lock(mutex_);
  hand_over_locked();
}

// With the mutex held all the while: the order within a topic must not depend on who is faster.
void Outbox::hand_over_locked() {
  for (auto& [route, message] : messages_) route->writer->enqueue(std::move(message));
  messages_.clear();
  size_ = 0;
}

}  // namespace furrow::graph
