#pragma once

#include <filesystem>

namespace furrow {

/// A new, empty folder below the system's temporary folder ($TMPDIR). The destructor removes it
/// with its content. The constructor throws std::runtime_error when the folder cannot be made.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace furrow
