#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "furrow_core/result.hpp"

namespace furrow {

/// The whole file. Errors name it: kNotFound, kIo, and kOutOfRange above `max_bytes`, so that a
/// wrong path does not fill the memory.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path,
                                            std::size_t max_bytes = 256u << 20);

/// Writes beside the target, syncs to the disk, renames over the target and syncs its folder: a
/// reader sees the old file or the new one, never a part, also after a loss of power. Returns when
/// the disk has the file. Parent folders are made. On failure the target is as it was, and the
/// Error (kIo) says why; only where the folder alone could not be synced is the new file in place
/// already.
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& path,
                                           std::string_view content);

}  // namespace furrow
