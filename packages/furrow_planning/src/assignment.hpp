#pragma once

#include <cstdint>
#include <vector>

#include "prepared_problem.hpp"

namespace furrow::planning {

/// How targets are divided among the axes in service, before the routes are planned.
enum class Assignment : std::uint8_t {
  kDistance,  ///< in the order of x, each to the axis whose last target (or head) is nearest
  kStatic,    ///< the width in equal lanes, one for each axis
  kDynamic,   ///< the width in lanes of equal load: the same sum of weights
};

/// Writes for each axis the indices of its nodes, ascending. A node that no axis in service spans
/// goes to none.
void assign(Assignment assignment, const PreparedProblem& prepared,
            std::vector<std::vector<std::uint32_t>>& members);

}  // namespace furrow::planning
