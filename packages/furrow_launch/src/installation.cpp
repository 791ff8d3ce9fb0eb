#include "furrow_launch/installation.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "furrow_core/error.hpp"

namespace furrow::launch {

std::filesystem::path share_folder() {
  if (const char* folder = std::getenv("FURROW_SHARE")) return folder;
  std::error_code failure;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", failure);
  return program.parent_path().parent_path() / "share" / "furrow";
}

std::filesystem::path find_shipped(const std::string& name, const std::string& kind) {
  if (std::filesystem::is_regular_file(name)) return name;
  const auto folder = share_folder() / "params" / kind;
  const auto shipped = folder / (name + ".yaml");
  if (std::filesystem::is_regular_file(shipped)) return shipped;
  std::vector<std::string> names;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    names.push_back(entry.path().stem().string());
  }
  std::ranges::sort(names);
  std::string list;
  for (const std::string& known : names) list += (list.empty() ? "" : ", ") + known;
  throw ConfigError("'" + name + "' is neither a file nor one of the shipped " + kind + ": " +
                    (list.empty() ? "none found in " + folder.string() : list));
}

graph::Registry make_registry() {
  graph::Registry registry;
  if (const char* path = std::getenv("FURROW_COMPONENT_PATH")) {
    std::istringstream folders(path);
    for (std::string folder; std::getline(folders, folder, ':');) {
      if (!folder.empty()) registry.add_search_folder(folder);
    }
  }
  registry.add_search_folder(FURROW_COMPONENT_FOLDER);
  registry.add_search_folder(FURROW_RECORDING_FOLDER);
  return registry;
}

}  // namespace furrow::launch
