#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "furrow_graph/transport.hpp"

namespace furrow::graph {

class Node;

/// The subscribers of a topic that a component of this process publishes.
struct Route {
  struct Reader {
    Node* node;
    std::size_t input;
  };

  /// Hands the message to the transport if an external subscriber reads it, or may come later and
  /// read a latched topic.
  void write_to_transport(const MessagePtr& message) const {
    if (writer == nullptr) return;
    if (qos.durability == msgs::Durability::kTransientLocal || writer->has_readers()) {
      writer->write(message);
    }
  }

  msgs::Qos qos;
  std::vector<Reader> readers;              ///< in this process
  std::unique_ptr<TransportWriter> writer;  ///< to other processes; null: no transport
  std::uint32_t topic_index = 0;            ///< among the graph's connections
};

}  // namespace furrow::graph
