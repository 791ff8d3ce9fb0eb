#include "json_node.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace furrow::annotation {

JsonNode::JsonNode(const nlohmann::json& json, std::string key)
    : json_(json), key_(std::move(key)) {}

bool JsonNode::has(const char* name) const {
  const auto found = json_.is_object() ? json_.find(name) : json_.end();
  return found != json_.end() && !found->is_null();
}

JsonNode JsonNode::at(const char* name) const {
  if (!has(name)) throw Malformed{path(name), "is missing"};
  return {json_.at(name), path(name)};
}

JsonNode JsonNode::entry(std::size_t i) const {
  return {json_.at(i), key_ + "[" + std::to_string(i) + "]"};
}

std::size_t JsonNode::size() const {
  if (!json_.is_array()) throw Malformed{key_, "is not a list"};
  return json_.size();
}

double JsonNode::number() const {
  if (!json_.is_number()) throw Malformed{key_, "is not a number"};
  return json_.get<double>();
}

std::int64_t JsonNode::integer(std::int64_t low, std::int64_t high) const {
  if (json_.is_number_unsigned() && json_.get<std::uint64_t>() > static_cast<std::uint64_t>(high)) {
    throw Malformed{key_, "is out of range"};
  }
  if (!json_.is_number_integer()) {
    const double value = number();
    if (value != std::floor(value)) throw Malformed{key_, "is not an integer"};
    if (value < static_cast<double>(low) || value > static_cast<double>(high) ||
        std::abs(value) > 1e15) {
      throw Malformed{key_, "is out of range"};
    }
    return static_cast<std::int64_t>(value);
  }
  const auto value = json_.get<std::int64_t>();
  if (value < low || value > high) throw Malformed{key_, "is out of range"};
  return value;
}

std::int64_t JsonNode::id() const {
  return integer(std::numeric_limits<std::int64_t>::min(),
                 std::numeric_limits<std::int64_t>::max());
}

std::string JsonNode::text() const {
  if (!json_.is_string()) throw Malformed{key_, "is not a string"};
  return json_.get<std::string>();
}

bool JsonNode::truth() const {
  if (json_.is_boolean()) return json_.get<bool>();
  return integer(0, 1) == 1;
}

bool JsonNode::is_true(const char* name) const {
  return has(name) && json_.at(name) == true;
}

bool JsonNode::is_text(const char* name, const char* text) const {
  return has(name) && json_.at(name) == text;
}

bool JsonNode::is_object() const {
  return json_.is_object();
}
bool JsonNode::is_string() const {
  return json_.is_string();
}

std::string JsonNode::path(const char* name) const {
  return key_.empty() ? name : key_ + "." + name;
}

}  // namespace furrow::annotation
