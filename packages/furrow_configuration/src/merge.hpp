#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::configuration {

/// Adds a parameter, or replaces the one with its name.
inline void merge(std::vector<GivenParameter>& parameters, GivenParameter parameter) {
  const auto it = std::ranges::find(parameters, parameter.name, &GivenParameter::name);
  if (it == parameters.end()) {
    parameters.push_back(std::move(parameter));
  } else {
    *it = std::move(parameter);
  }
}

}  // namespace furrow::configuration
