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

class Participant;

/// One endpoint, for health reports.
struct EndpointStatus {
  std::string topic;
  bool writer = false;
  int peers = 0;                ///< matched endpoints of other processes
  int best_effort_writers = 0;  ///< of these, writers whose messages may get lost unnoticed
  graph::TransportCounters counters;
  std::uint64_t deadlines_missed = 0;   ///< of a reader, by its topic's deadline
  std::uint64_t liveliness_losses = 0;  ///< matched writers of other processes that fell silent
  std::uint64_t incompatible = 0;       ///< endpoints that do not match because of their QoS
  /// Of the last one: "reliability: offered best effort, requested reliable (process 'camera')".
  std::string incompatibility;
};

/// One participant of a DDS domain, which connects a process with others. Topics are "rt/NAME" in
/// DDS, with ROS 2's type names, so that ROS 2 and other DDS programs take part.
///
/// Two threads serialize and send, one of them for topics with large messages. So an image does not
/// delay a command, and the publishing thread never serializes. Write a TRANSIENT_LOCAL topic also
/// while has_readers() is false: late joiners get its last messages. A volatile message without a
/// reader is dropped and not counted.
///
/// Endpoints must be destroyed before the transport. Two transports in one process count as two
/// processes.
class DdsTransport final : public graph::Transport {
 public:
  /// Joins the domain. Throws ConfigError if a parameter is out of range, an address is malformed
  /// or DDS refuses the participant, and std::system_error if a thread cannot be started.
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
  /// A reader gets messages only if it requests no more than the writer offers. Use the reliability
  /// and durability that discovery() lists for the writer, and no deadline.
  [[nodiscard]] std::unique_ptr<RawReader> make_raw_reader(
      const std::string& topic, const std::string& type_name, const msgs::Qos& qos,
      std::function<void(RawMessage)> on_message);

  [[nodiscard]] DiscoverySnapshot discovery() const;
  /// DiscoverySnapshot::version, without the snapshot.
  [[nodiscard]] std::uint64_t discovery_version() const;

  /// The existing endpoints, in the order of their construction.
  [[nodiscard]] std::vector<EndpointStatus> status() const;

  /// Waits until every queue is empty and all reliable readers have acknowledged. False after
  /// `timeout`.
  [[nodiscard]] bool flush(Duration timeout);

 private:
  std::unique_ptr<Participant> participant_;
};

}  // namespace furrow::dds
