#pragma once

#include <filesystem>
#include <memory>

#include "furrow_core/result.hpp"
#include "furrow_recording/byte_stream.hpp"

namespace furrow::recording {

/// A file that appears under its name when it is whole. Until then it stands beside it as
/// "NAME.partPID", which the destructor removes.
class NewFile {
 public:
  explicit NewFile(std::filesystem::path path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// kInvalidArgument when the name is taken, kIo when the file cannot be made.
  [[nodiscard]] Result<std::unique_ptr<mcap::Sink>> create();
  /// Gives the file its name. kInvalidArgument when the name was taken meanwhile; kIo. @pre the
  /// sink is closed.
  [[nodiscard]] Status publish();

 private:
  std::filesystem::path path_;
  std::filesystem::path part_;
  bool created_ = false;
};

}  // namespace furrow::recording
