#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "furrow_core/error.hpp"

namespace furrow {

/// For tests only: writes a file, and the folders that it needs. Returns `path`.
inline std::filesystem::path write_text(const std::filesystem::path& path,
                                        const std::string& text) {
  std::filesystem::create_directories(path.parent_path());
  std::ofstream(path) << text;
  return path;
}

/// For tests only: the text of the ConfigError that `call` throws, with paths relative to `folder`;
/// "" if it throws none.
template <class Call>
std::string error_of(const std::filesystem::path& folder, Call call) {
  try {
    call();
  } catch (const ConfigError& error) {
    std::string text = error.what();
    const std::string prefix = folder.string() + "/";
    for (auto at = text.find(prefix); !folder.empty() && at != std::string::npos;
         at = text.find(prefix)) {
      text.erase(at, prefix.size());
    }
    return text;
  }
  return "";
}

}  // namespace furrow
