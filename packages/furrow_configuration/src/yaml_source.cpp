#include "yaml_source.hpp"

#include <charconv>
#include <set>

#include "furrow_configuration/parameter_file.hpp"
#include "furrow_core/file.hpp"

namespace furrow::configuration {
namespace {

bool parse_integer(const std::string& text, std::int64_t& value) {
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, failure] = std::from_chars(begin, text.data() + text.size(), value);
  return failure == std::errc() && end == text.data() + text.size() && !text.empty();
}

bool parse_number(const std::string& text, double& value) {
  if (text.empty() || text.find_first_of("0123456789") == std::string::npos) {
    if (text == ".inf" || text == ".nan" || text == "-.inf") {
      return YAML::convert<double>::decode(YAML::Node(text), value);
    }
    return false;
  }
  const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, failure] = std::from_chars(begin, text.data() + text.size(), value);
  return failure == std::errc() && end == text.data() + text.size();
}

ParameterValue scalar_value(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;  // quoted
  if (text == "true") return true;
  if (text == "false") return false;
  std::int64_t integer = 0;
  if (parse_integer(text, integer)) return integer;
  double number = 0.0;
  if (parse_number(text, number)) return number;
  return text;
}

ParameterValue list_value(const YAML::Node& node) {
  std::vector<double> numbers;
  std::vector<std::string> texts;
  for (const YAML::Node& entry : node) {
    if (!entry.IsScalar()) throw YAML::RepresentationException(entry.Mark(), "not a plain value");
    double number = 0.0;
    if (entry.Tag() != "!" && parse_number(entry.Scalar(), number)) numbers.push_back(number);
    texts.push_back(entry.Scalar());
  }
  if (numbers.size() == texts.size()) return numbers;
  return texts;
}

bool is_path(std::string_view name) {
  return name.ends_with("_file") || name.ends_with("_folder");
}

}  // namespace

YamlSource::YamlSource(const std::filesystem::path& path) : path_(path) {
  const auto content = read_file(path, 16u << 20);
  if (!content.ok()) throw ConfigError(content.error().message);
  try {
    root_ = YAML::Load(*content);
  } catch (const YAML::Exception& failure) {
    throw ConfigError({path.string(), failure.mark.line + 1}, "", failure.msg);
  }
  if (!root_.IsMap()) throw ConfigError({path.string(), 1}, "", "is not a map of keys");
}

SourceLocation YamlSource::where(const YAML::Node& node) const {
  return {path_.string(), node.Mark().line + 1};
}

void YamlSource::each(const YAML::Node& map, std::string_view what, const MapVisitor& visit) const {
  if (map.IsNull()) return;
  if (!map.IsMap()) throw ConfigError(where(map), what, "is not a map of keys");
  std::set<std::string> seen;
  for (const auto& entry : map) {
    if (!entry.first.IsScalar())
      throw ConfigError(where(entry.first), what, "has a key that is not a single word");
    const std::string key = entry.first.Scalar();
    if (!seen.insert(key).second) throw ConfigError(where(entry.first), key, "is given twice");
    visit(key, entry.first, entry.second);
  }
}

std::string YamlSource::text(const YAML::Node& node, std::string_view key) const {
  if (!node.IsScalar()) throw ConfigError(where(node), key, "must be a single value");
  return node.Scalar();
}

std::vector<std::string> YamlSource::texts(const YAML::Node& node, std::string_view key) const {
  if (node.IsScalar()) return {node.Scalar()};
  if (!node.IsSequence()) throw ConfigError(where(node), key, "is not a list");
  std::vector<std::string> list;
  for (const YAML::Node& entry : node) list.push_back(text(entry, key));
  return list;
}

ParameterValue YamlSource::value(const YAML::Node& node) {
  return node.IsScalar() ? scalar_value(node) : list_value(node);
}

std::vector<GivenParameter> YamlSource::parameters(const YAML::Node& map,
                                                   std::string_view what) const {
  std::vector<GivenParameter> given;
  each(map, what, [&](const std::string& key, const YAML::Node& key_node, const YAML::Node& node) {
    GivenParameter parameter{key, {}, where(key_node)};
    if (!node.IsScalar() && !node.IsSequence()) {
      throw ConfigError(where(key_node), key, "must have one value or a list of values");
    }
    try {
      parameter.value = value(node);
    } catch (const YAML::Exception&) {
      throw ConfigError(where(key_node), key, "must be a value or a list of values");
    }
    if (auto* path = std::get_if<std::string>(&parameter.value);
        path != nullptr && is_path(key) && !path->empty()) {
      *path = (folder() / *path).lexically_normal().string();
    }
    given.push_back(std::move(parameter));
  });
  return given;
}

}  // namespace furrow::configuration
