#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

namespace furrow {

/// Calls `work(i)` once for each i < count and returns when all calls have. `threads` counts the
/// calling thread, which works too; 0: as many as the machine has. With one thread the calls are
/// made in order and nothing is allocated. A call must write only data that belongs to its i; then
/// the result is the same for any number of threads. Rethrows the exception of the smallest i that
/// throws. Calls with a larger i that have not started by then are skipped.
void parallel_for(std::size_t count, std::size_t threads,
                  const std::function<void(std::size_t)>& work);

/// Divides [0, count) into one band for each thread and calls `work(first, last)` for each, as
/// parallel_for does.
template <class Work>
void parallel_bands(int count, int threads, const Work& work) {
  const int bands = std::clamp(threads, 1, std::max(count, 1));
  const auto edge = [&](int band) {
    return static_cast<int>(static_cast<long long>(count) * band / bands);
  };
  parallel_for(static_cast<std::size_t>(bands), static_cast<std::size_t>(bands),
               [&](std::size_t i) {
                 const int band = static_cast<int>(i);
                 work(edge(band), edge(band + 1));
               });
}

}  // namespace furrow
