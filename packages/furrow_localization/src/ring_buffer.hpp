#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

namespace furrow::localization {

/// A queue of bounded length in one block of memory, with insertion near its end.
template <class T>
class RingBuffer {
 public:
  /// @pre capacity > 0.
  explicit RingBuffer(std::size_t capacity) : slots_(capacity) {}

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] bool full() const { return size_ == slots_.size(); }
  /// The i-th oldest.
  [[nodiscard]] T& operator[](std::size_t i) { return slots_[(head_ + i) % slots_.size()]; }
  [[nodiscard]] const T& operator[](std::size_t i) const {
    return slots_[(head_ + i) % slots_.size()];
  }
  [[nodiscard]] const T& front() const { return (*this)[0]; }
  [[nodiscard]] const T& back() const { return (*this)[size_ - 1]; }

  void clear() {
    head_ = 0;
    size_ = 0;
  }
  void pop_front() {
    assert(size_ > 0);
    head_ = (head_ + 1) % slots_.size();
    --size_;
  }
  /// Makes room before the i-th oldest by moving the newer elements; returns the free element.
  /// @pre not full, i <= size().
  [[nodiscard]] T& insert(std::size_t i) {
    assert(!full() && i <= size_);
    ++size_;
    for (std::size_t k = size_ - 1; k > i; --k) (*this)[k] = (*this)[k - 1];
    return (*this)[i];
  }

 private:
  std::vector<T> slots_;
  std::size_t head_ = 0;
  std::size_t size_ = 0;
};

}  // namespace furrow::localization
