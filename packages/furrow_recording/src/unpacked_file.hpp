#pragma once

#include <filesystem>

#include "furrow_core/result.hpp"

namespace furrow::recording {

/// A temporary file with the content of a zstd file, removed by the destructor. It is in $TMPDIR,
/// else in /var/tmp, which unlike /tmp is not in memory.
class UnpackedFile {
 public:
  /// kParse when `path` is not a whole zstd file, kIo when it cannot be read, or unpacking it would
  /// leave less than 100 MB on the disk.
  [[nodiscard]] static Result<UnpackedFile> make(const std::filesystem::path& path);
  UnpackedFile(UnpackedFile&& other) noexcept;
  UnpackedFile& operator=(UnpackedFile&& other) noexcept;
  ~UnpackedFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit UnpackedFile(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

}  // namespace furrow::recording
