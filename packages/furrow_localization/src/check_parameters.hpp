#pragma once

#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::localization {

/// Throws ConfigError when a parameter holds a value outside its declared range.
template <class Parameters>
void check_ranges(Parameters parameters) {
  ParameterLister lister;
  parameters.visit(lister);
  std::vector<GivenParameter> given;
  for (const DeclaredParameter& declared : lister.declared()) {
    given.push_back({declared.info.name, declared.default_value, {}});
  }
  check_parameters(lister.declared(), given);
}

}  // namespace furrow::localization
