#pragma once

#include <cstddef>

namespace furrow::actuation::testing {

/// How often this thread has called operator new so far.
[[nodiscard]] std::size_t allocations();

}  // namespace furrow::actuation::testing
