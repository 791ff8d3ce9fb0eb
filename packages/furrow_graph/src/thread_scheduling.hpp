#pragma once

#include <string>

namespace furrow::graph {

/// Gives the calling thread SCHED_FIFO with this priority. Returns why it was refused, or "".
[[nodiscard]] std::string use_fifo_scheduling(int priority);

/// Locks the memory of the process, present and future, at its first use. Locking all reserved
/// memory (stacks, libraries, shared memory) would cost hundreds of megabytes. Returns why it was
/// refused, or "". It is refused where a limit would make later allocations fail.
[[nodiscard]] std::string lock_memory();

/// Touches the calling thread's stack, so that it causes no page fault later.
void touch_stack();

}  // namespace furrow::graph
