#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "furrow_core/result.hpp"
#include "furrow_log/log.hpp"

namespace furrow::log {

enum class Clock : std::uint8_t {
  kUnix,       ///< times are printed as local date and time
  kSimulated,  ///< times are printed as seconds
};

/// Lines for people, "TIME LEVEL COMPONENT: MESSAGE", on standard error; in colour on a terminal,
/// where each line first clears a progress bar.
[[nodiscard]] std::shared_ptr<Sink> make_console_sink(Clock clock);

enum class FileStart : std::uint8_t {
  kReplace,  ///< a new file, also where one exists
  kAppend,   ///< after the lines of an existing file, such as those before a restart
};

/// The same lines in a file. At 10 MiB it is renamed to NAME.1.EXTENSION and a new one begins, so
/// that at most two exist. kIo: the file cannot be opened.
[[nodiscard]] Result<std::shared_ptr<Sink>> make_file_sink(const std::filesystem::path& path,
                                                           Clock clock,
                                                           FileStart start = FileStart::kReplace);
/// The older file of a file sink: NAME.1.EXTENSION.
[[nodiscard]] std::filesystem::path older_log(const std::filesystem::path& path);

}  // namespace furrow::log
