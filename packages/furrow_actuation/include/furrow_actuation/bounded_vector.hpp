#pragma once

#include <array>
#include <cassert>
#include <cstddef>

namespace furrow::actuation {

/// A vector of at most `Capacity` values without allocation.
template <class T, std::size_t Capacity>
class BoundedVector {
 public:
  /// False, and nothing is stored, when it is full.
  bool push_back(const T& value) {
    if (size_ == Capacity) return false;
    values_[size_++] = value;
    return true;
  }
  void clear() { size_ = 0; }
  void erase_front() {
    assert(size_ > 0);
    for (std::size_t i = 1; i < size_; ++i) values_[i - 1] = values_[i];
    --size_;
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] static constexpr std::size_t capacity() { return Capacity; }
  T& operator[](std::size_t i) { return assert(i < size_), values_[i]; }
  const T& operator[](std::size_t i) const { return assert(i < size_), values_[i]; }
  [[nodiscard]] const T& front() const { return (*this)[0]; }
  [[nodiscard]] const T& back() const { return (*this)[size_ - 1]; }
  [[nodiscard]] const T* begin() const { return values_.data(); }
  [[nodiscard]] const T* end() const { return values_.data() + size_; }
  [[nodiscard]] T* begin() { return values_.data(); }
  [[nodiscard]] T* end() { return values_.data() + size_; }

 private:
  std::array<T, Capacity> values_{};
  std::size_t size_ = 0;
};

}  // namespace furrow::actuation
