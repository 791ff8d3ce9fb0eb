#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "furrow_msgs/message_type.hpp"
#include "furrow_msgs/qos.hpp"

namespace furrow::graph {

using MessagePtr = std::shared_ptr<const void>;

/// Messages of one endpoint since its construction.
struct TransportCounters {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t dropped = 0;  ///< full queue, malformed message, or refused by the middleware
};

/// Sends one topic to other processes.
class TransportWriter {
 public:
  virtual ~TransportWriter() = default;
  /// True while a reader of another process is matched. Cheap: called at every publication.
  [[nodiscard]] virtual bool has_readers() const = 0;
  /// Puts the message into a bounded queue, which drops its oldest message when it is full. Another
  /// thread serializes and sends it. Never blocks.
  virtual void write(MessagePtr message) = 0;
  [[nodiscard]] virtual TransportCounters counters() const = 0;
};

/// Receives one topic from other processes. Messages of this process are left out.
class TransportReader {
 public:
  virtual ~TransportReader() = default;
  [[nodiscard]] virtual TransportCounters counters() const = 0;
  /// The number of matched writers of other processes.
  [[nodiscard]] virtual int writers() const = 0;
};

/// The middleware as the graph sees it. Topic names have no prefix here.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Throws ConfigError if the middleware refuses the endpoint.
  [[nodiscard]] virtual std::unique_ptr<TransportWriter> make_writer(const std::string& topic,
                                                                     const msgs::MessageType& type,
                                                                     const msgs::Qos& qos) = 0;
  /// As make_writer(). The receive thread calls `on_message`, which must not block.
  [[nodiscard]] virtual std::unique_ptr<TransportReader> make_reader(
      const std::string& topic, const msgs::MessageType& type, const msgs::Qos& qos,
      std::function<void(MessagePtr)> on_message) = 0;
};

}  // namespace furrow::graph
