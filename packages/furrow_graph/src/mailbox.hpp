#pragma once

#include <cstddef>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_graph/transport.hpp"

namespace furrow::graph {

/// A message in a mailbox.
struct Mail {
  std::size_t input = 0;
  MessagePtr message;
  Time arrived;
};

/// The messages of a node in the order of arrival, over all its inputs: a ring buffer. It allocates
/// only when it holds more messages than ever before, so that a delivery does not wait for memory.
/// Not thread-safe.
class Mailbox {
 public:
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::size_t size() const { return count_; }

  void push(Mail mail);
  /// Removes the oldest message. @pre Not empty.
  Mail pop();
  /// Removes the oldest message of one input. @pre There is one.
  Mail take_oldest_of(std::size_t input);

 private:
  static constexpr std::size_t kFirstCapacity = 16;

  /// The i-th oldest.
  [[nodiscard]] Mail& at(std::size_t i) { return ring_[(first_ + i) % ring_.size()]; }
  void grow();

  std::vector<Mail> ring_ = std::vector<Mail>(kFirstCapacity);
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace furrow::graph
