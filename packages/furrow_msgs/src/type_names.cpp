#include "furrow_msgs/type_names.hpp"

namespace furrow::msgs {
namespace {

constexpr std::string_view kDdsScope = "::msg::dds_::";
constexpr std::string_view kRosScope = "/msg/";

}  // namespace

std::string ros_type_name(std::string_view type_name) {
  const std::size_t scope = type_name.find(kDdsScope);
  if (scope == std::string_view::npos || !type_name.ends_with('_')) {
    return std::string(type_name);
  }
  const std::string_view name = type_name.substr(scope + kDdsScope.size());
  return std::string(type_name.substr(0, scope)) + std::string(kRosScope) +
         std::string(name.substr(0, name.size() - 1));
}

std::string dds_type_name(std::string_view type_name) {
  const std::size_t scope = type_name.find(kRosScope);
  if (scope == std::string_view::npos) {
    return std::string(type_name);
  }
  return std::string(type_name.substr(0, scope)) + std::string(kDdsScope) +
         std::string(type_name.substr(scope + kRosScope.size())) + "_";
}

}  // namespace furrow::msgs
