#pragma once

#include <filesystem>
#include <string>

#include "furrow_graph/registry.hpp"

namespace furrow::launch {

/// The folder of the shipped params, urdf and idl: $FURROW_SHARE, or beside the installed program.
[[nodiscard]] std::filesystem::path share_folder();

/// A file as the user names it: a path that exists, or the name of a shipped one (NAME.yaml in
/// share/params/KIND). Throws ConfigError that lists the shipped names.
[[nodiscard]] std::filesystem::path find_shipped(const std::string& name, const std::string& kind);

/// A registry that finds the shipped components and those of $FURROW_COMPONENT_PATH.
[[nodiscard]] graph::Registry make_registry();

}  // namespace furrow::launch
