#include "allocation_count.hpp"

#include <cstdlib>
#include <new>

namespace {

thread_local constinit std::uint64_t count = 0;

}  // namespace

// Not inlined, so that compilers see the operators match where they are used.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++count;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

std::uint64_t furrow::cli::thread_allocations() {
  return count;
}
