#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace furrow::recording {

/// Reads the values of an XCDR1 message of either endianness. After the first fault ok() is false,
/// and values are zero or empty.
class CdrCursor {
 public:
  explicit CdrCursor(std::span<const std::byte> cdr) {
    constexpr std::size_t kHeaderBytes = 4;
    // Plain CDR is 0 (big endian) or 1; others are parameter lists and XCDR2.
    ok_ = cdr.size() >= kHeaderBytes && cdr[0] == std::byte{0} &&
          (cdr[1] == std::byte{0} || cdr[1] == std::byte{1});
    if (ok_) {
      const bool little = cdr[1] == std::byte{1};
      swap_ = little != (std::endian::native == std::endian::little);
      body_ = cdr.subspan(kHeaderBytes);
    }
  }

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t left() const { return body_.size() - at_; }
  void fail() { ok_ = false; }

  template <class T>
  T number() {
    align(sizeof(T));
    std::array<std::byte, sizeof(T)> bytes{};
    const auto view = raw(sizeof(T));
    std::ranges::copy(view, bytes.begin());
    if (swap_) {
      std::ranges::reverse(bytes);
    }
    return std::bit_cast<T>(bytes);
  }

  /// Without its final zero.
  std::string_view string() {
    const auto length = number<std::uint32_t>();
    const auto view = raw(length);
    if (!ok_ || view.empty()) {
      return {};  // some writers give an empty string no zero
    }
    return {reinterpret_cast<const char*>(view.data()), view.size() - 1};
  }

  /// The length of a sequence. Every element has at least one byte.
  std::size_t count() {
    const auto count = number<std::uint32_t>();
    if (count > left()) {
      ok_ = false;
    }
    return ok_ ? count : 0;
  }

  void align(std::size_t size) {
    const std::size_t padding = (size - at_ % size) % size;
    (void)raw(padding);
  }

  std::span<const std::byte> raw(std::size_t size) {
    if (!ok_ || size > left()) {
      ok_ = false;
      return {};
    }
    at_ += size;
    return body_.subspan(at_ - size, size);
  }

 private:
  std::span<const std::byte> body_;
  std::size_t at_ = 0;
  bool swap_ = false;
  bool ok_ = false;
};

}  // namespace furrow::recording
