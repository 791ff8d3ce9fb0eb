#pragma once

#include <string>

namespace furrow::graph {

/// Gives the calling thread SCHED_FIFO with this priority; empty, or why it was refused.
[[nodiscard]] std::string use_fifo_scheduling(int priority);

/// Locks the memory of the process, present and future; empty, or why it was refused. Refused where
/// a limit would make later allocations fail.
[[nodiscard]] std::string lock_memory();

}  // namespace furrow::graph
