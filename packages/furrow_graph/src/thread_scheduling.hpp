#pragma once

#include <string>

namespace furrow::graph {

/// Gives the calling thread SCHED_FIFO with this priority; empty, or why it was refused.
[[nodiscard]] std::string use_fifo_scheduling(int priority);

/// Locks the memory of the process, present and future, as it is used for the first time: to take
/// all that is reserved (stacks, libraries, the shared memory of others) would cost each process
/// hundreds of megabytes. Empty, or why it was refused. Refused where a limit would make later
/// allocations fail.
[[nodiscard]] std::string lock_memory();

/// Uses the calling thread's stack once, so that it is there when time counts.
void touch_stack();

}  // namespace furrow::graph
