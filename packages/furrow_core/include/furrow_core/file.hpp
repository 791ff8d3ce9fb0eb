#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "furrow_core/result.hpp"

namespace furrow {

/// The whole file, or kNotFound / kIo. Files above `max_bytes` are refused (kOutOfRange), so that a
/// wrong path does not fill the memory.
[[nodiscard]] Result<std::string> read_file(const std::filesystem::path& path,
                                            std::size_t max_bytes = 256u << 20);

/// Writes beside the target and renames over it: a reader sees the old file or the new one, never a
/// part. Parent folders are made. On failure the target is as it was and the Error says why.
[[nodiscard]] Status write_file_atomically(const std::filesystem::path& path,
                                           std::string_view content);

}  // namespace furrow
