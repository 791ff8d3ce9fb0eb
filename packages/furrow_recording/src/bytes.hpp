#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::mcap {

using Bytes = std::vector<std::byte>;
using ByteView = std::span<const std::byte>;

/// Appends fields in MCAP's encoding (little endian, length before content).
class ByteWriter {
 public:
  explicit ByteWriter(Bytes& bytes) : bytes_(bytes) {}

  template <std::unsigned_integral T>
  void number(T value) {
    std::array<std::byte, sizeof(T)> field{};
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      field[i] = static_cast<std::byte>(value >> (8 * i));
    }
    raw(field);
  }
  void time(Time time) { number(static_cast<std::uint64_t>(time.count_ns())); }
  void raw(ByteView view) { bytes_.insert(bytes_.end(), view.begin(), view.end()); }
  void string(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size()));
    raw(std::as_bytes(std::span(text)));
  }
  void map(const StringMap& values) {
    const std::size_t length_at = begin_array();
    for (const auto& [key, value] : values) {
      string(key);
      string(value);
    }
    end_array(length_at);
  }
  void map(const std::map<ChannelId, std::uint64_t>& values) {
    number(static_cast<std::uint32_t>(values.size() * 10));
    for (const auto& [key, value] : values) {
      number(key);
      number(value);
    }
  }
  [[nodiscard]] std::size_t begin_array() {
    const std::size_t at = bytes_.size();
    number(std::uint32_t{0});
    return at;
  }
  void end_array(std::size_t length_at) {
    overwrite(length_at, static_cast<std::uint32_t>(bytes_.size() - length_at - 4));
  }
  /// Writes opcode and an empty length, which end_record() fills in.
  [[nodiscard]] std::size_t begin_record(std::uint8_t opcode) {
    number(opcode);
    const std::size_t at = bytes_.size();
    number(std::uint64_t{0});
    return at;
  }
  /// What was appended to the record so far.
  [[nodiscard]] ByteView content_of(std::size_t length_at) const {
    return ByteView(bytes_).subspan(length_at + sizeof(std::uint64_t));
  }
  void end_record(std::size_t length_at) {
    overwrite(length_at, static_cast<std::uint64_t>(bytes_.size() - length_at - 8));
  }

 private:
  template <std::unsigned_integral T>
  void overwrite(std::size_t at, T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes_[at + i] = static_cast<std::byte>(value >> (8 * i));
    }
  }
  Bytes& bytes_;
};

/// Reads fields from the front. Beyond the end it returns zeros, and ok() stays false.
class ByteReader {
 public:
  explicit ByteReader(ByteView bytes) : bytes_(bytes) {}

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }
  /// The bytes not read yet.
  [[nodiscard]] ByteView rest() const { return bytes_; }

  template <std::unsigned_integral T>
  T number() {
    const ByteView view = raw(sizeof(T));
    T value = 0;
    for (std::size_t i = 0; i < view.size(); ++i) {
      value = static_cast<T>(value |
                             (static_cast<T>(std::to_integer<std::uint8_t>(view[i])) << (8 * i)));
    }
    return value;
  }
  /// A time that messages are ordered by. ok() becomes false beyond 2^63 ns (year 2262).
  Time time() {
    const auto ns = number<std::uint64_t>();
    if (ns > static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
      ok_ = false;
      return {};
    }
    return Time::from_nanoseconds(static_cast<std::int64_t>(ns));
  }
  /// A time that only describes. Values beyond 2^63 become negative and are written back unchanged:
  /// some writers put 2^64-1 where there is no message.
  Time described_time() {
    return Time::from_nanoseconds(static_cast<std::int64_t>(number<std::uint64_t>()));
  }
  ByteView raw(std::uint64_t size) {
    if (!ok_ || size > bytes_.size()) {
      ok_ = false;
      return {};
    }
    const ByteView view = bytes_.first(static_cast<std::size_t>(size));
    bytes_ = bytes_.subspan(static_cast<std::size_t>(size));
    return view;
  }
  std::string string() {
    const ByteView view = raw(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(view.data()), view.size()};
  }
  StringMap string_map() {
    ByteReader entries(raw(number<std::uint32_t>()));
    StringMap values;
    while (entries.ok() && entries.left() > 0) {
      std::string key = entries.string();
      values.insert_or_assign(std::move(key), entries.string());
    }
    ok_ = ok_ && entries.ok();
    return values;
  }
  std::map<ChannelId, std::uint64_t> number_map() {
    ByteReader entries(raw(number<std::uint32_t>()));
    std::map<ChannelId, std::uint64_t> values;
    while (entries.ok() && entries.left() > 0) {
      const auto key = entries.number<ChannelId>();
      values.insert_or_assign(key, entries.number<std::uint64_t>());
    }
    ok_ = ok_ && entries.ok();
    return values;
  }

 private:
  ByteView bytes_;
  bool ok_ = true;
};

}  // namespace furrow::mcap
