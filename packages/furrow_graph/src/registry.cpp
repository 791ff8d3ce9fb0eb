#include "furrow_graph/registry.hpp"

#include <dlfcn.h>

#include <algorithm>

namespace furrow::graph {
namespace {
constexpr std::string_view kPrefix = "libfurrow_component_";
}

void Registry::add(ComponentClass entry) {
  const std::string name = entry.name;
  if (!classes_.emplace(name, std::move(entry)).second) {
    throw ConfigError("component class '" + name + "' is registered twice");
  }
}

void Registry::load_library(const std::filesystem::path& path) {
  if (loaded_.contains(path)) return;
  // Never closed: classes and messages of the library may exist until the process ends.
  void* library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    throw ConfigError({path.string(), 0}, "", std::string("cannot load: ") + ::dlerror());
  }
  using Register = void (*)(Registry&);
  const auto function = reinterpret_cast<Register>(::dlsym(library, "furrow_register"));
  if (function == nullptr) {
    throw ConfigError({path.string(), 0}, "", "is not a component library: no furrow_register");
  }
  loaded_.insert(path);
  function(*this);
}

const ComponentClass& Registry::find(const std::string& name, const SourceLocation& where) {
  if (const auto it = classes_.find(name); it != classes_.end()) return it->second;
  std::string looked;
  for (const auto& folder : folders_) {
    const auto path = folder / (std::string(kPrefix) + name + ".so");
    if (std::filesystem::exists(path)) {
      load_library(path);
      if (const auto it = classes_.find(name); it != classes_.end()) return it->second;
    }
    looked += (looked.empty() ? "" : ", ") + folder.string();
  }
  throw ConfigError(where, "class",
                    "unknown component class '" + name + "'; looked for " + std::string(kPrefix) +
                        name + ".so in: " + (looked.empty() ? "(no folder)" : looked));
}

void Registry::add_search_folder(std::filesystem::path folder) {
  if (std::ranges::find(folders_, folder) == folders_.end()) folders_.push_back(std::move(folder));
}

void Registry::load_all() {
  for (const auto& folder : folders_) {
    std::error_code failure;
    for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
      const std::string file = entry.path().filename().string();
      if (!file.starts_with(kPrefix) || !file.ends_with(".so")) continue;
      const std::string name = file.substr(kPrefix.size(), file.size() - kPrefix.size() - 3);
      if (!classes_.contains(name)) load_library(entry.path());
    }
  }
}

std::vector<const ComponentClass*> Registry::classes() const {
  std::vector<const ComponentClass*> list;
  for (const auto& [name, entry] : classes_) list.push_back(&entry);
  return list;
}

}  // namespace furrow::graph
