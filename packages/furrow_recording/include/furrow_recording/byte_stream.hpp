#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow::mcap {

/// The target of a file's bytes.
class Sink {
 public:
  virtual ~Sink() = default;
  /// Appends all bytes. After kIo a part may have been appended.
  [[nodiscard]] virtual Status write(std::span<const std::byte> bytes) = 0;
  /// Drops everything behind the first `size` bytes.
  [[nodiscard]] virtual Status truncate(std::uint64_t size) = 0;
  /// Returns when all written bytes are on the medium.
  [[nodiscard]] virtual Status sync() = 0;
};

/// The source of a file's bytes.
class Source {
 public:
  virtual ~Source() = default;
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// Fills `bytes` from `offset`. kOutOfRange beyond the end, kIo when the system refuses.
  [[nodiscard]] virtual Status read(std::uint64_t offset, std::span<std::byte> bytes) const = 0;
};

/// Makes a new file. An existing file is kept and refused (kIo). Each write reaches the operating
/// system, so that bytes survive the end of this process.
[[nodiscard]] Result<std::unique_ptr<Sink>> create_file(const std::filesystem::path& path);
/// Opens a file: kNotFound or kIo. Bytes appended after opening are not seen.
[[nodiscard]] Result<std::unique_ptr<Source>> open_file(const std::filesystem::path& path);

/// Appends to `bytes`, which must outlive the sink.
[[nodiscard]] std::unique_ptr<Sink> memory_sink(std::vector<std::byte>& bytes);
/// Reads `bytes`, which must outlive the source.
[[nodiscard]] std::unique_ptr<Source> memory_source(std::span<const std::byte> bytes);

}  // namespace furrow::mcap
