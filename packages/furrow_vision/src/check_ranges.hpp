#pragma once

#include "furrow_core/parameters.hpp"

namespace furrow::vision {

/// Throws ConfigError when a value that `parameters` holds is outside the range it declares: a
/// struct filled by code is held to what a parameter file is.
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

}  // namespace furrow::vision
