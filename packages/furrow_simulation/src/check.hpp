#pragma once

#include "furrow_core/parameters.hpp"

namespace furrow::simulation {

/// The parameters as they are. Throws ConfigError when one is out of its declared range.
template <class Parameters>
[[nodiscard]] Parameters checked(Parameters parameters) {
  validate_parameters(parameters);
  return parameters;
}

}  // namespace furrow::simulation
