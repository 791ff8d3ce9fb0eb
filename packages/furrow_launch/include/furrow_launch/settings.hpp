#pragma once

#include <string>
#include <vector>

#include "furrow_core/parameters.hpp"

namespace furrow::launch {

/// "KEY=VALUE" texts of the command line as parameters; values are read as in a parameter file.
/// Throws ConfigError that names `option` and the text.
[[nodiscard]] std::vector<GivenParameter> given_parameters(const std::vector<std::string>& settings,
                                                           const std::string& option = "--set");

}  // namespace furrow::launch
