#include "furrow_recording/byte_stream.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <system_error>

namespace furrow::mcap {
namespace {

Error system_error(const std::string& what, ErrorCode code = ErrorCode::kIo) {
  return {code, what + ": " + std::generic_category().message(errno)};
}

// The page cache allocates blocks as large as a call allows. A virtual machine returns free blocks
// of 2 MiB and more to its host. Writing to such a block fetches it again, at a fifth of the disk's
// speed.
constexpr std::size_t kMaxBytesOfCall = std::size_t{1} << 20;

// Writeback starts this often, instead of when the kernel finds too much waiting.
constexpr off_t kBytesPerWriteback = off_t{8} << 20;

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { close(fd_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

class FileSink final : public Sink {
 public:
  FileSink(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}

  Status write(std::span<const std::byte> bytes) override {
    while (!bytes.empty()) {
      const ssize_t written =
          ::write(fd_.get(), bytes.data(), std::min(bytes.size(), kMaxBytesOfCall));
      if (written < 0) {
        if (errno == EINTR) {
          continue;
        }
        return system_error("cannot write " + path_);
      }
      bytes = bytes.subspan(static_cast<std::size_t>(written));
      size_ += written;
      start_writeback();
    }
    return {};
  }

  Status truncate(std::uint64_t size) override {
    const auto offset = static_cast<off_t>(size);
    if (ftruncate(fd_.get(), offset) != 0 || lseek(fd_.get(), offset, SEEK_SET) != offset) {
      return system_error("cannot shorten " + path_);
    }
    size_ = offset;
    writeback_started_ = std::min(writeback_started_, offset);
    return {};
  }

  Status sync() override {
    return fdatasync(fd_.get()) == 0 ? Status() : system_error("cannot sync " + path_);
  }

 private:
  void start_writeback() {
    if (size_ - writeback_started_ >= kBytesPerWriteback) {
      // A hint: sync() reports errors of the disk.
      (void)sync_file_range(fd_.get(), writeback_started_, size_ - writeback_started_,
                            SYNC_FILE_RANGE_WRITE);
      writeback_started_ = size_;
    }
  }

  Descriptor fd_;
  std::string path_;
  off_t size_ = 0;
  off_t writeback_started_ = 0;
};

class FileSource final : public Source {
 public:
  FileSource(int fd, std::string path) : fd_(fd), path_(std::move(path)) {}

  [[nodiscard]] Status stat() {
    struct stat info {};
    if (fstat(fd_.get(), &info) != 0) {
      return system_error("cannot read " + path_);
    }
    if (!S_ISREG(info.st_mode)) {
      return Error{ErrorCode::kIo, path_ + " is no regular file"};
    }
    size_ = static_cast<std::uint64_t>(info.st_size);
    return {};
  }

  [[nodiscard]] std::uint64_t size() const override { return size_; }

  Status read(std::uint64_t offset, std::span<std::byte> bytes) const override {
    while (!bytes.empty()) {
      const ssize_t got = pread(fd_.get(), bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (got < 0 && errno == EINTR) {
        continue;
      }
      if (got < 0) {
        return system_error("cannot read " + path_);
      }
      if (got == 0) {
        return Error{ErrorCode::kOutOfRange, path_ + " ends before what is to be read"};
      }
      offset += static_cast<std::uint64_t>(got);
      bytes = bytes.subspan(static_cast<std::size_t>(got));
    }
    return {};
  }

 private:
  Descriptor fd_;
  std::string path_;
  std::uint64_t size_ = 0;
};

class MemorySink final : public Sink {
 public:
  explicit MemorySink(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  Status write(std::span<const std::byte> bytes) override {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return {};
  }
  Status truncate(std::uint64_t size) override {
    bytes_.resize(static_cast<std::size_t>(size));
    return {};
  }
  Status sync() override { return {}; }

 private:
  std::vector<std::byte>& bytes_;
};

class MemorySource final : public Source {
 public:
  explicit MemorySource(std::span<const std::byte> bytes) : bytes_(bytes) {}
  [[nodiscard]] std::uint64_t size() const override { return bytes_.size(); }
  Status read(std::uint64_t offset, std::span<std::byte> bytes) const override {
    if (offset > bytes_.size() || bytes.size() > bytes_.size() - offset) {
      return Error{ErrorCode::kOutOfRange, "the data end before what is to be read"};
    }
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), bytes.size(), bytes.begin());
    return {};
  }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace

Result<std::unique_ptr<Sink>> create_file(const std::filesystem::path& path) {
  const int fd = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  if (fd < 0) {
    return system_error("cannot make " + path.string());
  }
  return std::unique_ptr<Sink>(std::make_unique<FileSink>(fd, path.string()));
}

Result<std::unique_ptr<Source>> open_file(const std::filesystem::path& path) {
  const int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) {
    return system_error("cannot open " + path.string(),
                        errno == ENOENT ? ErrorCode::kNotFound : ErrorCode::kIo);
  }
  auto source = std::make_unique<FileSource>(fd, path.string());
  if (Status status = source->stat(); !status) {
    return status.error();
  }
  return std::unique_ptr<Source>(std::move(source));
}

std::unique_ptr<Sink> memory_sink(std::vector<std::byte>& bytes) {
  return std::make_unique<MemorySink>(bytes);
}

std::unique_ptr<Source> memory_source(std::span<const std::byte> bytes) {
  return std::make_unique<MemorySource>(bytes);
}

}  // namespace furrow::mcap
