#pragma once

#include "furrow_core/parameters.hpp"

namespace furrow::field {

/// Throws ConfigError when a parameter of the struct is out of its declared range or choices.
template <class Parameters>
void check_declared_ranges(Parameters parameters) {
  ParameterLister lister;
  parameters.visit(lister);
  std::vector<GivenParameter> given;
  given.reserve(lister.declared().size());
  for (const DeclaredParameter& declared : lister.declared()) {
    given.push_back({declared.info.name, declared.default_value, {}});
  }
  check_parameters(lister.declared(), given);
}

}  // namespace furrow::field
