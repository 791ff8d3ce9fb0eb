#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::configuration {

/// A YAML file with the locations of its nodes.
class YamlSource {
 public:
  /// Throws ConfigError if the file cannot be read or is not YAML.
  explicit YamlSource(const std::filesystem::path& path);

  [[nodiscard]] const YAML::Node& root() const { return root_; }
  [[nodiscard]] SourceLocation where(const YAML::Node& node) const;
  [[nodiscard]] std::filesystem::path folder() const { return path_.parent_path(); }

  using MapVisitor = std::function<void(const std::string& key, const YAML::Node& key_node,
                                        const YAML::Node& value)>;
  /// Calls back for each entry of a map, in the order of the file. `what` names the map in errors.
  /// A key that is given twice is an error.
  void each(const YAML::Node& map, std::string_view what, const MapVisitor& visit) const;
  [[nodiscard]] std::string text(const YAML::Node& node, std::string_view key) const;
  [[nodiscard]] std::vector<std::string> texts(const YAML::Node& node, std::string_view key) const;
  /// A scalar or a list of scalars. Throws YAML::Exception for anything else.
  [[nodiscard]] static ParameterValue value(const YAML::Node& node);
  /// A map of parameters. Relative paths are taken from this file's folder.
  [[nodiscard]] std::vector<GivenParameter> parameters(const YAML::Node& map,
                                                       std::string_view what) const;

 private:
  std::filesystem::path path_;
  YAML::Node root_;
};

}  // namespace furrow::configuration
