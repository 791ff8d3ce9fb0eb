#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "furrow_msgs/message_type.hpp"

namespace furrow::graph {

/// A message that another process reads.
struct StepMessage {
  std::uint32_t topic = 0;      ///< index into the graph's connections
  std::uint32_t component = 0;  ///< the publisher's index in the graph
  std::vector<std::byte> cdr;
};

/// One process's part of a simulation step, sent to all others (docs/decisions/0005).
struct Step {
  std::uint64_t number = 0;
  std::uint64_t run = 0;       ///< digest of graph, deployment and seed
  std::uint64_t instance = 0;  ///< a random number of each start of the process
  std::int64_t next_timer_ns = 0;
  std::string process;
  bool stop = false;  ///< a component requested the end of the run, or failed
  bool failed = false;
  bool aborted = false;               ///< the process leaves now, outside the order of steps
  std::string reason;                 ///< of the stop
  std::vector<std::uint32_t> topics;  ///< published in this step, ascending
  std::vector<StepMessage> messages;  ///< by component, then in the order of publication
};

[[nodiscard]] const msgs::MessageType& step_type();

}  // namespace furrow::graph
