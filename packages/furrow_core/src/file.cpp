#include "furrow_core/file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <system_error>
#include <utility>

namespace furrow {
namespace {

Error io_error(const std::filesystem::path& path, std::string_view doing, int error_number) {
  return {ErrorCode::kIo, path.string() + ": " + std::string(doing) + ": " +
                              std::generic_category().message(error_number)};
}

/// Closes a file when it goes out of scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const { return number_; }
  /// The result of close(), which may tell of a failed write.
  [[nodiscard]] int close() { return ::close(std::exchange(number_, -1)); }

 private:
  int number_;
};

Status write_all(int descriptor, std::string_view content, const std::filesystem::path& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return io_error(path, "cannot write", errno);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

/// Creates, fills and syncs a file.
Status write_synced(const std::filesystem::path& path, std::string_view content) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
  if (file.number() < 0) return io_error(path, "cannot open", errno);
  if (Status status = write_all(file.number(), content, path); !status.ok()) return status;
  if (::fsync(file.number()) != 0) return io_error(path, "cannot sync to the disk", errno);
  if (file.close() != 0) return io_error(path, "cannot close", errno);
  return {};
}

Status sync_folder(const std::filesystem::path& folder) {
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened.number() < 0) return io_error(folder, "cannot open the folder", errno);
  // EINVAL: this file system cannot sync folders.
  if (::fsync(opened.number()) != 0 && errno != EINVAL) {
    return io_error(folder, "cannot sync the folder to the disk", errno);
  }
  return {};
}

/// Unique for each process and call: two writers of one file must not share it.
std::filesystem::path part_of(const std::filesystem::path& path) {
  static std::atomic<unsigned> calls = 0;
  return path.string() + ".part" + std::to_string(::getpid()) + "_" + std::to_string(calls++);
}

/// Writes the content into a file beside `path` and has `put_in_place` rename it: 0, or errno.
template <class PutInPlace>
Status write_beside(const std::filesystem::path& path, std::string_view content,
                    PutInPlace put_in_place) {
  std::error_code failure;
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  std::filesystem::create_directories(folder, failure);
  if (failure) return io_error(folder, "cannot make the folder", failure.value());
  const std::filesystem::path part = part_of(path);
  Status status = write_synced(part, content);
  if (status.ok() && put_in_place(part) != 0) {
    status = io_error(path, "cannot put in place", errno);
  }
  if (!status.ok()) {
    std::filesystem::remove(part, failure);
    return status;
  }
  return sync_folder(folder);
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path, std::size_t max_bytes) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0) {
    if (errno != ENOENT && errno != ENOTDIR) return io_error(path, "cannot open", errno);
    return Error{ErrorCode::kNotFound, path.string() + ": no such file"};
  }
  struct stat status {};
  if (::fstat(file.number(), &status) != 0) return io_error(path, "cannot read", errno);
  if (!S_ISREG(status.st_mode)) {
    return Error{ErrorCode::kIo, path.string() + ": not a regular file"};
  }
  const Error too_large{ErrorCode::kOutOfRange, path.string() + ": more than the limit of " +
                                                    std::to_string(max_bytes) + " bytes"};
  if (static_cast<std::uint64_t>(status.st_size) > max_bytes) return too_large;
  // The size is only a hint: files of /proc have size 0, and a file may grow.
  std::string content;
  std::size_t filled = 0;
  for (std::size_t room = static_cast<std::size_t>(status.st_size) + 1;; room = 64u << 10) {
    if (filled + room > max_bytes + 1) room = max_bytes + 1 - filled;
    content.resize(filled + room);
    const ssize_t got = ::read(file.number(), content.data() + filled, room);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return io_error(path, "cannot read", errno);
    if (got == 0) break;
    filled += static_cast<std::size_t>(got);
    if (filled > max_bytes) return too_large;
  }
  content.resize(filled);
  return content;
}

Status write_file_atomically(const std::filesystem::path& path, std::string_view content) {
  return write_beside(path, content, [&path](const std::filesystem::path& part) {
    return std::rename(part.c_str(), path.c_str());
  });
}

Result<bool> write_new_file(const std::filesystem::path& path, std::string_view content) {
  bool exists = false;
  const Status status = write_beside(path, content, [&](const std::filesystem::path& part) {
    const int result =
        ::renameat2(AT_FDCWD, part.c_str(), AT_FDCWD, path.c_str(), RENAME_NOREPLACE);
    exists = result != 0 && errno == EEXIST;
    return result;
  });
  if (exists) return false;
  if (!status.ok()) return status.error();
  return true;
}

}  // namespace furrow
