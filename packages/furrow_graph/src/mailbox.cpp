#include "mailbox.hpp"

#include <utility>

namespace furrow::graph {

void Mailbox::push(Mail mail) {
  if (count_ == ring_.size()) grow();
  at(count_) = std::move(mail);
  ++count_;
}

Mail Mailbox::pop() {
  Mail mail = std::move(ring_[first_]);
  first_ = (first_ + 1) % ring_.size();
  --count_;
  return mail;
}

Mail Mailbox::take_oldest_of(std::size_t input) {
  std::size_t i = 0;
  while (at(i).input != input) ++i;
  Mail mail = std::move(at(i));
  // Fewer messages are before it, as a rule, than behind it.
  for (; i > 0; --i) at(i) = std::move(at(i - 1));
  first_ = (first_ + 1) % ring_.size();
  --count_;
  return mail;
}

void Mailbox::grow() {
  std::vector<Mail> larger(2 * ring_.size());
  for (std::size_t i = 0; i < count_; ++i) larger[i] = std::move(at(i));
  ring_ = std::move(larger);
  first_ = 0;
}

}  // namespace furrow::graph
