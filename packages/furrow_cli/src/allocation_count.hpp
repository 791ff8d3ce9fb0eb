#pragma once

#include <cstdint>

namespace furrow::cli {

/// How often the calling thread has called operator new so far. The command replaces the global
/// operators, which costs an increment for each call.
[[nodiscard]] std::uint64_t thread_allocations();

}  // namespace furrow::cli
