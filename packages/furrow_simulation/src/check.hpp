#pragma once

#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::simulation {

/// The parameters as they are. Throws ConfigError when one is out of its declared range.
template <class Parameters>
[[nodiscard]] Parameters checked(Parameters parameters) {
  ParameterLister lister;
  parameters.visit(lister);
  std::vector<GivenParameter> given;
  given.reserve(lister.declared().size());
  for (const DeclaredParameter& declared : lister.declared()) {
    given.push_back({declared.info.name, declared.default_value, {}});
  }
  check_parameters(lister.declared(), given);
  return parameters;
}

}  // namespace furrow::simulation
