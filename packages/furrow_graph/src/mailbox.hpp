#pragma once

#include <cstddef>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_graph/transport.hpp"

namespace furrow::graph {

/// A message that waits for its node.
struct Mail {
  std::size_t input = 0;
  MessagePtr message;
  Time arrived;
};

/// The mail of a node in the order of arrival, over all its inputs. It allocates only when it is
/// fuller than ever before: a hand-off must not wait for memory. Not thread-safe.
class Mailbox {
 public:
  [[nodiscard]] bool empty() const { return count_ == 0; }
  [[nodiscard]] std::size_t size() const { return count_; }

  void push(Mail mail);
  /// @pre Not empty, as for pop().
  [[nodiscard]] const Mail& front() const { return ring_[first_]; }
  Mail pop();
  /// Takes out the oldest of one input. @pre There is one.
  Mail take_oldest_of(std::size_t input);

 private:
  static constexpr std::size_t kFirstRoom = 16;

  /// The i-th oldest.
  [[nodiscard]] Mail& at(std::size_t i) { return ring_[(first_ + i) % ring_.size()]; }
  void make_room();

  std::vector<Mail> ring_ = std::vector<Mail>(kFirstRoom);
  std::size_t first_ = 0;
  std::size_t count_ = 0;
};

}  // namespace furrow::graph
