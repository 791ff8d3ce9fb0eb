#pragma once

#include <initializer_list>
#include <memory>
#include <optional>

#include "bytes.hpp"
#include "furrow_core/result.hpp"
#include "furrow_recording/byte_stream.hpp"

namespace furrow::mcap {

/// Appends whole records to a sink and keeps their CRC. When the sink refuses, the file is cut back
/// to its last whole record, and later calls return the same error until resume().
class FileAppender {
 public:
  explicit FileAppender(std::unique_ptr<Sink> sink) : sink_(std::move(sink)) {}

  struct Part {
    ByteView bytes;
    std::optional<std::uint32_t> crc = std::nullopt;  ///< of `bytes`, when it is known
    Part(const Bytes& content) : bytes(content) {}    // NOLINT(google-explicit-constructor)
    Part(ByteView content, std::uint32_t known) : bytes(content), crc(known) {}
  };
  /// Appends all parts or none.
  [[nodiscard]] Status append(std::initializer_list<Part> parts);
  /// Forgets an earlier failure, for one more attempt.
  void resume() { failed_.reset(); }
  [[nodiscard]] Status sync() { return sink_->sync(); }
  /// Closes the sink; nothing can be appended afterwards.
  void close() { sink_.reset(); }

  [[nodiscard]] Status failure() const { return failed_ ? Status(*failed_) : Status(); }
  [[nodiscard]] std::uint64_t position() const { return position_; }
  [[nodiscard]] std::uint32_t crc() const { return crc_; }

 private:
  std::unique_ptr<Sink> sink_;
  std::uint64_t position_ = 0;
  std::uint32_t crc_ = 0;
  std::optional<Error> failed_;
};

}  // namespace furrow::mcap
