#include <sys/statvfs.h>

#include <cerrno>
#include <system_error>

#include "furrow_recording/recorder.hpp"

namespace furrow::recording {

RecorderEnvironment RecorderEnvironment::of_this_machine() {
  RecorderEnvironment environment;
  environment.create_file = mcap::create_file;
  environment.free_bytes = [](const std::filesystem::path& path) -> Result<std::uint64_t> {
    struct statvfs info {};
    const auto folder =
        path.parent_path().empty() ? std::filesystem::path(".") : path.parent_path();
    if (statvfs(folder.c_str(), &info) != 0) {
      return Error{ErrorCode::kIo, "cannot tell the space left in " + folder.string() + ": " +
                                       std::generic_category().message(errno)};
    }
    return static_cast<std::uint64_t>(info.f_bavail) * info.f_frsize;
  };
  return environment;
}

}  // namespace furrow::recording
