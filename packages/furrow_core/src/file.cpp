#include "furrow_core/file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

namespace furrow {
namespace {

Error io_error(const std::filesystem::path& path, std::string_view doing, int error_number) {
  return {ErrorCode::kIo, path.string() + ": " + std::string(doing) + ": " +
                              std::generic_category().message(error_number)};
}

Status write_all(int descriptor, std::string_view content, const std::filesystem::path& path) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return io_error(path, "cannot write", errno);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

}  // namespace

Result<std::string> read_file(const std::filesystem::path& path, std::size_t max_bytes) {
  std::error_code failure;
  const auto status = std::filesystem::status(path, failure);
  if (!std::filesystem::exists(status)) {
    return Error{ErrorCode::kNotFound, path.string() + ": no such file"};
  }
  if (!std::filesystem::is_regular_file(status)) {
    return Error{ErrorCode::kIo, path.string() + ": not a regular file"};
  }
  const auto size = std::filesystem::file_size(path, failure);
  if (!failure && size > max_bytes) {
    return Error{ErrorCode::kOutOfRange, path.string() + ": " + std::to_string(size) +
                                             " bytes, more than the limit of " +
                                             std::to_string(max_bytes)};
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return io_error(path, "cannot open", errno);
  std::string content(failure ? 0 : size, '\0');
  stream.read(content.data(), static_cast<std::streamsize>(content.size()));
  if (stream.gcount() != static_cast<std::streamsize>(content.size())) {
    return io_error(path, "cannot read", errno);
  }
  return content;
}

Status write_file_atomically(const std::filesystem::path& path, std::string_view content) {
  std::error_code failure;
  if (path.has_parent_path()) {
    std::filesystem::create_directories(path.parent_path(), failure);
    if (failure) return io_error(path.parent_path(), "cannot make the folder", failure.value());
  }
  const std::filesystem::path part = path.string() + ".part" + std::to_string(::getpid());
  const int descriptor = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (descriptor < 0) return io_error(part, "cannot open", errno);
  Status status = write_all(descriptor, content, part);
  if (::close(descriptor) != 0 && status.ok()) status = io_error(part, "cannot close", errno);
  if (status.ok() && std::rename(part.c_str(), path.c_str()) != 0) {
    status = io_error(path, "cannot put in place", errno);
  }
  if (!status.ok()) std::filesystem::remove(part, failure);
  return status;
}

}  // namespace furrow
