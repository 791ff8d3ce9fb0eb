#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "furrow_core/time.hpp"
#include "furrow_msgs/message_type.hpp"
#include "furrow_msgs/qos.hpp"

namespace furrow::graph {

using MessagePtr = std::shared_ptr<const void>;

/// What goes through one endpoint of the transport since it was made.
struct TransportCounters {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;
  std::uint64_t dropped =
      0;  ///< left out by us: queue full, malformed, or the transport refused it
};

/// Sends one topic to other processes.
class TransportWriter {
 public:
  virtual ~TransportWriter() = default;
  /// True while a reader outside this process is matched. Cheap: asked at every publication.
  [[nodiscard]] virtual bool has_readers() const = 0;
  /// Hands the message over; serialized and sent by another thread, from a bounded queue whose
  /// oldest entry is dropped when full. Never blocks. Messages stay alive until they are sent.
  virtual void write(MessagePtr message) = 0;
  /// As write(), but no thread is woken: Transport::send_one() or wake_senders() must follow.
  virtual void enqueue(MessagePtr message) { write(std::move(message)); }
  [[nodiscard]] virtual TransportCounters counters() const = 0;
};

/// Receives one topic from other processes; what this process publishes itself is left out.
class TransportReader {
 public:
  virtual ~TransportReader() = default;
  [[nodiscard]] virtual TransportCounters counters() const = 0;
  /// Writers outside this process that are matched now.
  [[nodiscard]] virtual int writers() const = 0;
};

/// The middleware as the graph sees it. Topics are named without the transport's prefix.
class Transport {
 public:
  virtual ~Transport() = default;
  /// Errors (a refused QoS, no memory) throw ConfigError: endpoints are made at construction only.
  [[nodiscard]] virtual std::unique_ptr<TransportWriter> make_writer(const std::string& topic,
                                                                     const msgs::MessageType& type,
                                                                     const msgs::Qos& qos) = 0;
  /// `on_message` is called on the transport's thread and must not hold it up.
  [[nodiscard]] virtual std::unique_ptr<TransportReader> make_reader(
      const std::string& topic, const msgs::MessageType& type, const msgs::Qos& qos,
      std::function<void(MessagePtr)> on_message) = 0;

  // To wake a thread that sends costs as much as to wake a reader inside the process: a thread that
  // has nothing else to do sends what was enqueued in its place. On any thread:
  /// Something waits that no thread has begun to send. Cheap.
  [[nodiscard]] virtual bool has_waiting() const { return false; }
  /// Sends one message, where one waits; takes the longer the larger it is.
  virtual void send_one() {}
  virtual void wake_senders() {}
};

}  // namespace furrow::graph
