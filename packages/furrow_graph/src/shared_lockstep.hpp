#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "route.hpp"
#include "step_exchange.hpp"

namespace furrow::graph {

/// What a process knows of the other processes of its lock-step.
struct SharedLockstep {
  struct Topic {
    const msgs::MessageType* type = nullptr;
    std::vector<Route::Reader> readers;  ///< in this process
    std::vector<bool> read_by;           ///< by process, this one included
    bool read_elsewhere = false;
  };
  std::unique_ptr<StepExchange> exchange;
  std::vector<Topic> topics;                     ///< as the graph's connections
  std::vector<std::uint32_t> component_of_node;  ///< index in the graph, by node of this process
};

}  // namespace furrow::graph
