#pragma once

#include <filesystem>
#include <string_view>
#include <utility>
#include <vector>

#include "furrow_core/result.hpp"

namespace furrow {

// Where a command writes its results. The policy of all commands: results of an earlier command are
// not replaced. A taken name gets the next free number (out/demo-2, rows-2.json) unless the user
// asks to overwrite. A place that cannot be written is found before the work begins.

enum class Overwrite : bool { kNo, kYes };

/// A folder for the results of one command. Other processes that claim the same path while the
/// object lives get another folder. The destructor removes the folder if it is still empty and
/// claim() made it. Moves, but is not copied.
class OutputFolder {
 public:
  /// Makes the folder `wanted`, or the first of wanted-2, wanted-3, ... that is free. A folder is
  /// taken when it holds one of the files `results`, or when another process has claimed it; other
  /// files do not matter. With Overwrite::kYes earlier results do not count. Error when `wanted` is
  /// not a folder, when nothing can be written there, or when it is to be overwritten while another
  /// process writes it.
  [[nodiscard]] static Result<OutputFolder> claim(const std::filesystem::path& wanted,
                                                  const std::vector<std::string_view>& results,
                                                  Overwrite overwrite);
  OutputFolder(OutputFolder&& other) noexcept;
  OutputFolder& operator=(OutputFolder&& other) noexcept;
  ~OutputFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Whether path() is another folder than the one asked for.
  [[nodiscard]] bool numbered() const { return numbered_; }

 private:
  OutputFolder(std::filesystem::path path, int lock, bool made, bool numbered)
      : path_(std::move(path)), lock_(lock), made_(made), numbered_(numbered) {}
  std::filesystem::path path_;
  int lock_ = -1;  // an open folder with a lock; the system drops it with the process
  bool made_ = false;
  bool numbered_ = false;
};

/// A file for the results of one command. A device or pipe, such as /dev/stdout, is written as it
/// is.
class OutputFile {
 public:
  /// Checks that the file can be written, without leaving one. Error when it cannot, or when
  /// `wanted` is a folder.
  [[nodiscard]] static Result<OutputFile> claim(const std::filesystem::path& wanted,
                                                Overwrite overwrite);
  /// Writes the whole file or nothing. Where the name was taken since the claim, the next free
  /// number is used.
  [[nodiscard]] Status write(std::string_view content);

  /// After write() the file that was written; before it, the name that is free now.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Whether path() is another file than the one asked for.
  [[nodiscard]] bool numbered() const { return path_ != wanted_; }

 private:
  OutputFile(std::filesystem::path wanted, Overwrite overwrite)
      : wanted_(std::move(wanted)), path_(wanted_), overwrite_(overwrite) {}
  void take_next_free_name();
  std::filesystem::path wanted_;
  std::filesystem::path path_;
  Overwrite overwrite_ = Overwrite::kNo;
  int number_ = 1;
};

}  // namespace furrow
