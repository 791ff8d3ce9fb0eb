#include "new_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

namespace furrow::recording {
namespace {

Error taken(const std::filesystem::path& path) {
  return {ErrorCode::kInvalidArgument,
          path.string() + ": exists and is not overwritten; choose another name"};
}

}  // namespace

NewFile::NewFile(std::filesystem::path path)
    : path_(std::move(path)), part_(path_.string() + ".part" + std::to_string(::getpid())) {}

NewFile::~NewFile() {
  std::error_code ignored;
  if (created_) {
    std::filesystem::remove(part_, ignored);
  }
}

Result<std::unique_ptr<mcap::Sink>> NewFile::create() {
  std::error_code failure;
  if (std::filesystem::exists(std::filesystem::symlink_status(path_, failure))) {
    return taken(path_);
  }
  auto sink = mcap::create_file(part_);
  created_ = sink.ok();
  return sink;
}

Status NewFile::publish() {
  int done = ::renameat2(AT_FDCWD, part_.c_str(), AT_FDCWD, path_.c_str(), RENAME_NOREPLACE);
  if (done != 0 && errno == EINVAL) {
    // The file system cannot refuse to replace.
    std::error_code failure;
    if (std::filesystem::exists(std::filesystem::symlink_status(path_, failure))) {
      return taken(path_);
    }
    done = std::rename(part_.c_str(), path_.c_str());
  }
  if (done != 0) {
    return errno == EEXIST ? taken(path_)
                           : Error{ErrorCode::kIo, path_.string() + ": cannot be named: " +
                                                       std::generic_category().message(errno)};
  }
  created_ = false;
  return {};
}

}  // namespace furrow::recording
