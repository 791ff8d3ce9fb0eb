#include "strand_queue.hpp"

#include <utility>

#include "node.hpp"

namespace furrow::graph {

void StrandQueue::add(Node& node) {
  strands_[&node].timer_pending.assign(node.timers().size(), false);
}

void StrandQueue::enqueue(Node& node) {
  Strand& strand = strands_.at(&node);
  if (strand.running) {
    strand.again = true;
  } else if (!strand.queued) {
    strand.queued = true;
    ready_.push_back(&node);
  }
}

bool StrandQueue::enqueue_timer(Node& node, std::size_t timer, Time due) {
  Strand& strand = strands_.at(&node);
  if (strand.timer_pending[timer]) return false;
  strand.timer_pending[timer] = true;
  strand.due.push_back({timer, due});
  enqueue(node);
  return true;
}

StrandQueue::Call StrandQueue::begin_first() {
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

bool StrandQueue::begin_or_enqueue(Node& node) {
  Strand& strand = strands_.at(&node);
  if (strand.running || strand.queued) {
    enqueue(node);
    return false;
  }
  strand.running = true;
  strand.again = false;
  return true;
}

void StrandQueue::end(Node& node) {
  Strand& strand = strands_.at(&node);
  strand.running = false;
  if (strand.again || node.has_messages()) enqueue(node);
}

}  // namespace furrow::graph
