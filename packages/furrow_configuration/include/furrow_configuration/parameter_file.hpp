#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::configuration {

/// The entries of a YAML file that is one map of parameters. Throws ConfigError with file and line.
/// Names that end in _file or _folder hold paths: relative ones are taken from the file's folder.
[[nodiscard]] std::vector<GivenParameter> read_parameter_file(const std::filesystem::path& path);

/// A YAML file whose key `list` holds a list of maps; one vector of parameters per entry.
[[nodiscard]] std::vector<std::vector<GivenParameter>> read_parameter_list(
    const std::filesystem::path& path, std::string_view list);

/// The value of a text: `true`, `3`, `0.5`, `[1, 2]`, else a string.
[[nodiscard]] ParameterValue parse_parameter_value(std::string_view text);

/// Reads and checks a struct of parameters.
template <class Parameters>
[[nodiscard]] Parameters load_parameter_file(const std::filesystem::path& path) {
  Parameters parameters;
  ParameterLoader::load(read_parameter_file(path), parameters);
  return parameters;
}

template <class Parameters>
[[nodiscard]] std::vector<Parameters> load_parameter_list(const std::filesystem::path& path,
                                                          std::string_view list) {
  std::vector<Parameters> entries;
  for (const auto& given : read_parameter_list(path, list)) {
    ParameterLoader::load(given, entries.emplace_back());
  }
  return entries;
}

}  // namespace furrow::configuration
