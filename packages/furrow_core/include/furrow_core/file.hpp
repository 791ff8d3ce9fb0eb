#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "furrow_core/result.hpp"

namespace furrow {

/// Reads the whole file. Errors name the file: kNotFound, kIo, and kOutOfRange above `max_bytes`,
/// which bounds the memory for a wrong path.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path,
                                            std::size_t max_bytes = 256u << 20);

/// Writes a temporary file in the same folder, syncs it, renames it over the target and syncs the
/// folder. A reader sees the old file or the new one, never a part, even after a power loss.
/// Creates parent folders. Blocks until the disk has the file. On failure (kIo) the target is
/// unchanged, except when only the last step fails: the new file is in place, but may not survive a
/// power loss.
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& path,
                                           std::string_view content);

/// As write_file_atomically, but replaces nothing: false, and nothing is written, when something of
/// this name exists. Of several processes that write one path at a time, exactly one succeeds.
[[nodiscard]] Result<bool> write_new_file(const std::filesystem::path& path,
                                          std::string_view content);

}  // namespace furrow
