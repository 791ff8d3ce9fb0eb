#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "furrow_msgs/message_type.hpp"

namespace furrow::graph {

/// A message that some other process reads.
struct StepMessage {
  std::uint32_t topic = 0;      ///< index into the graph's connections
  std::uint32_t component = 0;  ///< of the publisher: its index in the graph
  std::vector<std::byte> cdr;
};

/// What one process tells all others of a step of the lock-step (see docs/decisions/0005).
struct Step {
  std::uint64_t number = 0;
  std::uint64_t run = 0;       ///< digest of graph, deployment and seed
  std::uint64_t instance = 0;  ///< differs each time the process is started
  std::int64_t next_timer_ns = 0;
  std::string process;
  bool stop = false;  ///< a component asked for the end of the run, or failed
  bool failed = false;
  bool aborted = false;               ///< out of turn: the process leaves now
  std::string reason;                 ///< of the stop
  std::vector<std::uint32_t> topics;  ///< that were published, in ascending order
  std::vector<StepMessage> messages;  ///< by component, and in the order of their publication
};

[[nodiscard]] const msgs::MessageType& step_type();

}  // namespace furrow::graph
