#include "furrow_core/parallel.hpp"

#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace furrow {

void parallel_for(std::size_t count, std::size_t threads,
                  const std::function<void(std::size_t)>& work) {
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  threads = std::min(threads, count);
  if (threads <= 1) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> least_failed = count;
  std::vector<std::exception_ptr> thrown(count);
  const auto take = [&] {
    for (std::size_t i = next++; i < least_failed; i = next++) {
      try {
        work(i);
      } catch (...) {
        thrown[i] = std::current_exception();
        std::size_t known = least_failed;
        while (i < known && !least_failed.compare_exchange_weak(known, i)) {
        }
      }
    }
  };
  {
    std::vector<std::jthread> others;
    others.reserve(threads - 1);
    for (std::size_t t = 1; t < threads; ++t) others.emplace_back(take);
    take();
  }
  if (least_failed < count) std::rethrow_exception(thrown[least_failed]);
}

}  // namespace furrow
