#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "furrow_dds/dds_parameters.hpp"
#include "furrow_dds/discovery.hpp"
#include "furrow_dds/raw.hpp"
#include "furrow_graph/transport.hpp"

namespace furrow::dds {

enum class TransportFaultKind {
  kDeadlineMissed,      ///< a reader waited longer than its topic's deadline
  kLivelinessLost,      ///< a matched writer of another process fell silent
  kLivelinessRegained,  ///< and is back
  kIncompatible,        ///< an endpoint of the topic does not match because of its QoS
};
struct TransportFault {
  TransportFaultKind kind = TransportFaultKind::kDeadlineMissed;
  std::string topic;
  /// kIncompatible: "reliability: offered best effort, requested reliable (process 'camera')".
  std::string detail;
};

/// One endpoint, for health reports.
struct EndpointStatus {
  std::string topic;
  bool writer = false;
  int peers = 0;                ///< matched endpoints of other processes
  int best_effort_writers = 0;  ///< of these, writers whose messages may get lost unnoticed
  graph::TransportCounters counters;
  std::uint64_t deadlines_missed = 0;
  std::uint64_t liveliness_losses = 0;
  std::uint64_t incompatible = 0;
  std::string incompatibility;  ///< TransportFault::detail of the last one
};

/// One participant of a DDS domain: how a process reaches others. Topics are "rt/NAME" in DDS,
/// with ROS 2's type names, so that ROS 2 and other DDS programs take part.
///
/// Writers send from two threads of the transport, one for topics with large messages, so that an
/// image does not hold up a command. Serialization is done there, never on the publishing thread.
/// A TRANSIENT_LOCAL topic must be written also while has_readers() is false: late joiners get its
/// last messages. Volatile messages without a reader are let go at once and not counted.
///
/// Endpoints must be destroyed before the transport. Two transports in one process count as two
/// processes.
class DdsTransport final : public graph::Transport {
 public:
  /// Joins the domain. Throws ConfigError when a parameter is out of range, an address malformed
  /// or the participant refused.
  explicit DdsTransport(const DdsParameters& parameters);
  ~DdsTransport() override;

  [[nodiscard]] std::unique_ptr<graph::TransportWriter> make_writer(const std::string& topic,
                                                                    const msgs::MessageType& type,
                                                                    const msgs::Qos& qos) override;
  [[nodiscard]] std::unique_ptr<graph::TransportReader> make_reader(
      const std::string& topic, const msgs::MessageType& type, const msgs::Qos& qos,
      std::function<void(graph::MessagePtr)> on_message) override;

  /// `type_name` as in DDS, e.g. "sensor_msgs::msg::dds_::Image_". Topics are named as in
  /// DiscoverySnapshot. Throws ConfigError.
  [[nodiscard]] std::unique_ptr<RawWriter> make_raw_writer(const std::string& topic,
                                                           const std::string& type_name,
                                                           const msgs::Qos& qos);
  /// A reader gets messages only when it asks for no more than the writer offers: take the
  /// writer's reliability and durability from the discovery, and no deadline.
  [[nodiscard]] std::unique_ptr<RawReader> make_raw_reader(
      const std::string& topic, const std::string& type_name, const msgs::Qos& qos,
      std::function<void(RawMessage)> on_message);

  [[nodiscard]] DiscoverySnapshot discovery() const;
  /// DiscoverySnapshot::version, without the snapshot.
  [[nodiscard]] std::uint64_t discovery_version() const;

  /// Called on the transport's thread and must only enqueue. Empty: no more calls.
  void on_fault(std::function<void(const TransportFault&)> callback);
  /// Every endpoint that is there now, in the order they were made.
  [[nodiscard]] std::vector<EndpointStatus> status() const;

  /// Waits until every queue is empty and reliable readers acknowledged; false when `timeout`
  /// passed before.
  [[nodiscard]] bool flush(Duration timeout);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::dds
