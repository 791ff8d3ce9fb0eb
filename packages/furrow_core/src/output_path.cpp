#include "furrow_core/output_path.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "furrow_core/file.hpp"

namespace furrow {
namespace {

namespace fs = std::filesystem;

/// Bounds the search: more results of one name than any user keeps.
constexpr int kMaxNumber = 10'000;

Error refusal(const fs::path& path, const std::string& why) {
  return {ErrorCode::kIo, path.string() + ": " + why};
}

std::string text_of(int error_number) {
  return std::generic_category().message(error_number);
}

/// out/demo and 2: out/demo-2; rows.json and 2: rows-2.json. 1: the path itself.
fs::path numbered_path(const fs::path& path, int number, bool keep_extension) {
  if (number == 1) return path;
  const std::string suffix = "-" + std::to_string(number);
  if (!keep_extension) return fs::path(path.string() + suffix);
  return path.parent_path() / (path.stem().string() + suffix + path.extension().string());
}

Status make_folder(const fs::path& path) {
  std::error_code failure;
  fs::create_directories(path, failure);
  if (failure) return refusal(path, "cannot make the folder: " + failure.message());
  return {};
}

/// Tries by writing: access rights alone do not tell of a full or read-only file system.
Status check_writable(const fs::path& folder) {
  std::string name = (folder / ".furrow_XXXXXX").string();
  const int file = ::mkstemp(name.data());
  if (file < 0) return refusal(folder, "cannot write into the folder: " + text_of(errno));
  ::close(file);
  ::unlink(name.c_str());
  return {};
}

bool holds_any(const fs::path& folder, const std::vector<std::string_view>& names) {
  return std::ranges::any_of(names, [&](std::string_view name) {
    std::error_code ignored;
    return fs::exists(fs::symlink_status(folder / name, ignored));
  });
}

/// False when the folder was removed, or replaced by another, since it was opened.
bool still_there(int opened, const fs::path& path) {
  struct stat by_descriptor {};
  struct stat by_path {};
  return ::fstat(opened, &by_descriptor) == 0 && ::stat(path.c_str(), &by_path) == 0 &&
         by_descriptor.st_dev == by_path.st_dev && by_descriptor.st_ino == by_path.st_ino;
}

/// "out/demo/" and "." have no last name to be numbered.
fs::path named(const fs::path& wanted) {
  fs::path path = wanted.lexically_normal();
  if (path.has_filename() && path.filename() != "." && path.filename() != "..") return path;
  path = fs::absolute(path).lexically_normal();
  return path.has_filename() ? path : path.parent_path();
}

}  // namespace

Result<OutputFolder> OutputFolder::claim(const fs::path& wanted,
                                         const std::vector<std::string_view>& results,
                                         Overwrite overwrite) {
  std::error_code failure;
  if (wanted.empty()) return refusal("\"\"", "names no folder");
  if (fs::exists(wanted, failure) && !fs::is_directory(wanted, failure)) {
    return refusal(wanted, "is not a folder");
  }
  for (int number = 1; number <= kMaxNumber; ++number) {
    const fs::path path = number == 1 ? wanted : numbered_path(named(wanted), number, false);
    const bool existed = fs::exists(path, failure);
    if (existed && !fs::is_directory(path, failure)) continue;
    if (Status made = make_folder(path); !made) return made.error();
    const int lock = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock < 0) return refusal(path, "cannot open the folder: " + text_of(errno));
    OutputFolder folder(path, lock, !existed, number != 1);
    // File systems without locks cannot tell of others; results still tell of earlier ones.
    const bool in_use = ::flock(lock, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    if (in_use) folder.made_ = false;
    if (!still_there(lock, path)) {  // an ending process removed its empty folder
      folder.made_ = false;
      --number;
      continue;
    }
    if (in_use && overwrite == Overwrite::kYes) {
      return refusal(path, "another process writes its results there");
    }
    if (in_use || (overwrite == Overwrite::kNo && holds_any(path, results))) continue;
    if (Status writable = check_writable(path); !writable) return writable.error();
    return folder;
  }
  return refusal(wanted, "has more than " + std::to_string(kMaxNumber) + " numbered folders");
}

OutputFolder::OutputFolder(OutputFolder&& other) noexcept
    : path_(std::move(other.path_)),
      lock_(std::exchange(other.lock_, -1)),
      made_(other.made_),
      numbered_(other.numbered_) {}

OutputFolder& OutputFolder::operator=(OutputFolder&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(lock_, other.lock_);
  std::swap(made_, other.made_);
  std::swap(numbered_, other.numbered_);
  return *this;
}

OutputFolder::~OutputFolder() {
  if (lock_ < 0) return;
  if (made_) ::rmdir(path_.c_str());  // fails, as it should, where something was written
  ::close(lock_);
}

Result<OutputFile> OutputFile::claim(const fs::path& wanted, Overwrite overwrite) {
  std::error_code failure;
  if (!wanted.has_filename()) return refusal(wanted, "names no file");
  if (fs::is_directory(wanted, failure)) return refusal(wanted, "is a folder, not a file");
  OutputFile file(wanted, overwrite);
  if (fs::exists(wanted, failure) && !fs::is_regular_file(wanted, failure)) return file;
  const fs::path folder = wanted.has_parent_path() ? wanted.parent_path() : fs::path(".");
  if (Status made = make_folder(folder); !made) return made.error();
  if (Status writable = check_writable(folder); !writable) return writable.error();
  file.take_next_free_name();
  return file;
}

void OutputFile::take_next_free_name() {
  std::error_code ignored;
  while (overwrite_ == Overwrite::kNo && number_ < kMaxNumber &&
         fs::exists(fs::symlink_status(path_, ignored))) {
    path_ = numbered_path(wanted_, ++number_, true);
  }
}

Status OutputFile::write(std::string_view content) {
  std::error_code failure;
  if (fs::exists(path_, failure) && !fs::is_regular_file(path_, failure)) {
    std::ofstream device(path_, std::ios::binary);
    device << content << std::flush;
    if (!device) return refusal(path_, "cannot write: " + text_of(errno));
    return {};
  }
  if (overwrite_ == Overwrite::kYes) return write_file_atomically(path_, content);
  while (number_ < kMaxNumber) {
    const auto written = write_new_file(path_, content);
    if (!written.ok()) return written.error();
    if (*written) return {};
    take_next_free_name();
  }
  return refusal(wanted_, "has more than " + std::to_string(kMaxNumber) + " numbered files");
}

}  // namespace furrow
