#include "ros2msg.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "furrow_msgs/idl_schema.hpp"

namespace furrow::recording {
namespace {

/// The ROS 2 name of an IDL primitive; other types stay.
std::string ros2_type(const std::string& idl_type) {
  static const std::map<std::string, std::string> types = {
      {"boolean", "bool"},          {"octet", "uint8"},
      {"float", "float32"},         {"double", "float64"},
      {"short", "int16"},           {"long", "int32"},
      {"unsigned short", "uint16"}, {"long long", "int64"},
      {"unsigned long", "uint32"},  {"unsigned long long", "uint64"}};
  const auto it = types.find(idl_type);
  return it == types.end() ? idl_type : it->second;
}

/// "pkg/msg/Type" for the root's name, "pkg/Type" inside definitions.
std::string slashed(const std::string& scoped, std::string_view between) {
  const std::size_t first = scoped.find("::");
  const std::size_t last = scoped.rfind("::");
  return scoped.substr(0, first) + std::string(between) + scoped.substr(last + 2);
}

std::string suffix(const msgs::IdlMember& member) {
  if (member.array_size > 0) return "[" + std::to_string(member.array_size) + "]";
  if (!member.sequence) return "";
  return member.bound > 0 ? "[<=" + std::to_string(member.bound) + "]" : "[]";
}

}  // namespace

Result<std::string> ros2msg_from_idl(std::string_view idl, std::string_view ros_name) {
  const auto schema = msgs::IdlSchema::parse(idl);
  if (!schema.ok()) return schema.error();
  std::vector<std::string> wanted;
  for (const std::string& name : schema->struct_names()) {
    if (slashed(name, "/msg/") == ros_name) wanted.push_back(name);
  }
  if (wanted.empty()) {
    return Error{ErrorCode::kNotFound, "the IDL has no type " + std::string(ros_name)};
  }
  std::set<std::string> known(wanted.begin(), wanted.end());
  std::string text;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    const std::string name = wanted[i];
    if (i > 0) text += std::string(80, '=') + "\nMSG: " + slashed(name, "/") + "\n";
    for (const msgs::IdlConstant& constant : schema->constants_of(name)) {
      text += ros2_type(constant.type) + " " + constant.name + "=" + constant.value + "\n";
    }
    for (const msgs::IdlMember& member : *schema->find(name)) {
      const bool nested = schema->find(member.type) != nullptr;
      if (nested && known.insert(member.type).second) wanted.push_back(member.type);
      text += (nested ? slashed(member.type, "/") : ros2_type(member.type)) + suffix(member) + " " +
              member.name + "\n";
    }
  }
  return text;
}

}  // namespace furrow::recording
