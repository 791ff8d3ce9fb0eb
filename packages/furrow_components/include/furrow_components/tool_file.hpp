#pragma once

#include <string>

#include "furrow_core/parameters.hpp"

namespace furrow::components {

/// The parameter of components that need the tool model only.
struct ToolFileParameters {
  std::string tool_file;

  void visit(ParameterVisitor& v) {
    v.visit({.name = "tool_file", .description = "URDF of robot and tool"}, tool_file);
  }
};

}  // namespace furrow::components
