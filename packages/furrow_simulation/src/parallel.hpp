#pragma once

#include <algorithm>
#include <thread>
#include <vector>

namespace furrow::simulation {

/// Calls work(first, last) on disjoint bands of [0, count), one on each thread.
template <class Work>
void for_bands(int count, int threads, const Work& work) {
  const int bands = std::clamp(threads, 1, std::max(count, 1));
  std::vector<std::jthread> others;
  others.reserve(static_cast<std::size_t>(bands - 1));
  for (int band = 1; band < bands; ++band) {
    others.emplace_back([&, band] { work(count * band / bands, count * (band + 1) / bands); });
  }
  work(0, count / bands);
}

}  // namespace furrow::simulation
