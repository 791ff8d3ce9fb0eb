#include "furrow_configuration/parameter_file.hpp"

#include "yaml_source.hpp"

namespace furrow::configuration {

std::vector<GivenParameter> read_parameter_file(const std::filesystem::path& path) {
  const YamlSource source(path);
  return source.parameters(source.root(), "");
}

std::vector<std::vector<GivenParameter>> read_parameter_list(const std::filesystem::path& path,
                                                             std::string_view list) {
  const YamlSource source(path);
  std::vector<std::vector<GivenParameter>> entries;
  source.each(source.root(), "",
              [&](const std::string& key, const YAML::Node& key_node, const YAML::Node& node) {
                if (key != list) throw ConfigError(source.where(key_node), key, "unknown key");
                if (!node.IsSequence())
                  throw ConfigError(source.where(key_node), key, "is not a list");
                for (const YAML::Node& entry : node) {
                  entries.push_back(source.parameters(entry, list));
                }
              });
  if (!source.root()[std::string(list)]) {
    throw ConfigError({path.string(), 1}, list, "is missing");
  }
  return entries;
}

ParameterValue parse_parameter_value(std::string_view text) {
  try {
    const YAML::Node node = YAML::Load("value: " + std::string(text));
    const YAML::Node value = node["value"];
    if (value.IsScalar() || value.IsSequence()) {
      // By the rules of a file, as a file of one line.
      return YamlSource::value(value);
    }
  } catch (const YAML::Exception&) {
    // Text that is not YAML is a string.
  }
  return std::string(text);
}

}  // namespace furrow::configuration
