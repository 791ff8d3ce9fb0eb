#include "unpacked_file.hpp"

#include <sys/statvfs.h>
#include <unistd.h>
#include <zstd.h>

#include <cerrno>
#include <cstdlib>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "furrow_recording/byte_stream.hpp"

namespace furrow::recording {
namespace {

constexpr std::uint64_t kFreeBytes = 100'000'000;
constexpr std::uint64_t kFreeCheckBytes = 32u << 20;

std::filesystem::path temporary_folder() {
  const char* const folder = std::getenv("TMPDIR");
  return folder != nullptr && *folder != '\0' ? folder : "/var/tmp";
}

/// A name that no other process uses.
std::filesystem::path unused_path() {
  static int count = 0;
  return temporary_folder() /
         ("furrow_" + std::to_string(::getpid()) + "_" + std::to_string(count++) + ".unpacked");
}

Status check_free(const std::filesystem::path& path) {
  struct statvfs disk {};
  if (::statvfs(path.parent_path().c_str(), &disk) == 0 &&
      std::uint64_t{disk.f_bavail} * disk.f_frsize < kFreeBytes) {
    return Error{ErrorCode::kIo, path.parent_path().string() +
                                     ": no room to unpack a compressed recording; set TMPDIR to a "
                                     "folder on a larger disk"};
  }
  return {};
}

class Unpacking {
 public:
  Unpacking(const mcap::Source& source, mcap::Sink& sink, const std::filesystem::path& target)
      : source_(source), sink_(sink), target_(target), out_(ZSTD_DStreamOutSize()) {}

  Status run() {
    std::vector<std::byte> in(ZSTD_DStreamInSize());
    std::size_t hint = 0;
    for (std::uint64_t at = 0; at < source_.size();) {
      in.resize(static_cast<std::size_t>(
          std::min<std::uint64_t>(ZSTD_DStreamInSize(), source_.size() - at)));
      if (Status status = source_.read(at, in); !status) {
        return status;
      }
      at += in.size();
      if (Status status = feed(in, hint); !status) {
        return status;
      }
    }
    return hint == 0 && written_ > 0
               ? Status()
               : Status(Error{ErrorCode::kParse, "the zstd file is cut short"});
  }

 private:
  Status feed(const std::vector<std::byte>& bytes, std::size_t& hint) {
    ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
    bool full = false;
    while (in.pos < in.size || full) {
      ZSTD_outBuffer out{out_.data(), out_.size(), 0};
      hint = ZSTD_decompressStream(context_.get(), &out, &in);
      if (ZSTD_isError(hint) != 0) {
        return Error{ErrorCode::kParse,
                     std::string("malformed zstd file: ") + ZSTD_getErrorName(hint)};
      }
      full = out.pos == out.size;
      if (Status status = write(out.pos); !status) {
        return status;
      }
    }
    return {};
  }

  Status write(std::size_t bytes) {
    if (written_ >= next_check_) {
      next_check_ = written_ + kFreeCheckBytes;
      if (Status status = check_free(target_); !status) {
        return status;
      }
    }
    written_ += bytes;
    return sink_.write(std::span(out_).first(bytes));
  }

  struct Free {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
  };
  const mcap::Source& source_;
  mcap::Sink& sink_;
  const std::filesystem::path& target_;
  std::unique_ptr<ZSTD_DCtx, Free> context_{ZSTD_createDCtx()};
  std::vector<std::byte> out_;
  std::uint64_t written_ = 0;
  std::uint64_t next_check_ = 0;
};

}  // namespace

Result<UnpackedFile> UnpackedFile::make(const std::filesystem::path& path) {
  const auto source = mcap::open_file(path);
  if (!source) {
    return source.error();
  }
  UnpackedFile file(unused_path());
  auto sink = mcap::create_file(file.path_);
  if (!sink) {
    file.path_.clear();  // of another process
    return sink.error();
  }
  if (Status status = Unpacking(**source, **sink, file.path_).run(); !status) {
    return Error{status.error().code, path.string() + ": " + status.error().message};
  }
  return file;
}

UnpackedFile::UnpackedFile(UnpackedFile&& other) noexcept
    : path_(std::exchange(other.path_, std::filesystem::path())) {}

UnpackedFile& UnpackedFile::operator=(UnpackedFile&& other) noexcept {
  std::swap(path_, other.path_);
  return *this;
}

UnpackedFile::~UnpackedFile() {
  std::error_code ignored;
  if (!path_.empty()) {
    std::filesystem::remove(path_, ignored);
  }
}

}  // namespace furrow::recording
