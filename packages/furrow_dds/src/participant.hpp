#pragma once

#include <chrono>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "discovery_listener.hpp"
#include "furrow_dds/dds_transport.hpp"
#include "sender.hpp"

namespace furrow::dds {

/// What DdsTransport asks of its endpoints.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  [[nodiscard]] virtual EndpointStatus status() const = 0;
  /// False when something is not delivered at `deadline`.
  [[nodiscard]] virtual bool flush(std::chrono::steady_clock::time_point deadline) = 0;
};

/// The participant and what its endpoints share.
class Participant {
 public:
  explicit Participant(const DdsParameters& parameters);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// A topic, held as long as an endpoint uses it. Throws ConfigError when the process has it with
  /// another type.
  class TopicUse {
   public:
    TopicUse(Participant& participant, const std::string& topic, const std::string& type_name);
    ~TopicUse();
    TopicUse(const TopicUse&) = delete;
    TopicUse& operator=(const TopicUse&) = delete;
    [[nodiscard]] eprosima::fastdds::dds::Topic* get() const { return topic_; }

   private:
    Participant& participant_;
    eprosima::fastdds::dds::Topic* topic_ = nullptr;
  };

  /// Is the endpoint with this handle one of this participant?
  [[nodiscard]] bool is_own(const eprosima::fastrtps::rtps::InstanceHandle_t& handle) const;

  [[nodiscard]] eprosima::fastdds::dds::Publisher& publisher() { return *publisher_; }
  [[nodiscard]] eprosima::fastdds::dds::Subscriber& subscriber() { return *subscriber_; }
  [[nodiscard]] Sender& sender() { return *sender_; }
  [[nodiscard]] const DiscoveryListener& discovery() const { return discovery_; }
  [[nodiscard]] const DdsParameters& parameters() const { return parameters_; }

  void set_on_fault(std::function<void(const TransportFault&)> callback);
  void report(TransportFaultKind kind, const std::string& topic);

  void add(Endpoint* endpoint);
  void remove(Endpoint* endpoint);
  [[nodiscard]] std::vector<EndpointStatus> status() const;
  [[nodiscard]] bool flush(std::chrono::steady_clock::time_point deadline);

  /// Flushes one endpoint at its end, from the time that all have together.
  void linger(Endpoint& endpoint);

 private:
  DdsParameters parameters_;
  DiscoveryListener discovery_;
  eprosima::fastdds::dds::DomainParticipant* participant_ = nullptr;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
  std::unique_ptr<Sender> sender_;

  std::mutex topics_mutex_;
  std::map<std::string, int> topic_uses_;

  std::mutex fault_mutex_;
  std::function<void(const TransportFault&)> on_fault_;

  mutable std::mutex endpoints_mutex_;
  std::vector<Endpoint*> endpoints_;

  std::mutex linger_mutex_;
  std::chrono::nanoseconds linger_left_{};
};

}  // namespace furrow::dds
