#pragma once

#include <cstddef>
#include <functional>

namespace furrow::experiments {

/// Calls `work(i)` once for each i < count, on `threads` threads (0: as many as the machine has),
/// in the order of i but not one after another. Rethrows what a call threw, of the least i; the
/// calls that have not started by then are left out.
void parallel_for(std::size_t count, std::size_t threads,
                  const std::function<void(std::size_t)>& work);

}  // namespace furrow::experiments
