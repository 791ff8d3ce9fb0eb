#pragma once

#include <chrono>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "discovery_listener.hpp"
#include "furrow_core/mutex.hpp"
#include "furrow_dds/dds_transport.hpp"
#include "sender.hpp"

namespace furrow::dds {

/// A writer or reader as DdsTransport sees it.
class Endpoint {
 public:
  virtual ~Endpoint() = default;
  [[nodiscard]] virtual EndpointStatus status() const = 0;
  /// False if a message is not delivered at `deadline`.
  [[nodiscard]] virtual bool flush(std::chrono::steady_clock::time_point deadline) = 0;
};

struct ParticipantDeleter {
  void operator()(eprosima::fastdds::dds::DomainParticipant* participant) const;
};
using ParticipantHandle =
    std::unique_ptr<eprosima::fastdds::dds::DomainParticipant, ParticipantDeleter>;

/// Counts the endpoints that do not match one of ours because of their QoS. Thread-safe.
class IncompatibilityLog {
 public:
  void add(const std::string& detail);
  void add_to(EndpointStatus& status) const;

 private:
  mutable Mutex mutex_;
  std::uint64_t count_ FURROW_GUARDED_BY(mutex_) = 0;
  std::string last_ FURROW_GUARDED_BY(mutex_);
};

/// The DDS participant of a process and the state that its endpoints share.
class Participant {
 public:
  /// Throws ConfigError, or std::system_error if no thread can be started. Leaves nothing behind.
  explicit Participant(const DdsParameters& parameters);
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// A DDS topic, which exists as long as an endpoint uses it. Throws ConfigError if the process
  /// uses the topic with another type.
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

  /// True for an endpoint of this participant.
  [[nodiscard]] bool is_own(const eprosima::fastrtps::rtps::InstanceHandle_t& handle) const;

  [[nodiscard]] eprosima::fastdds::dds::Publisher& publisher() { return *publisher_; }
  [[nodiscard]] eprosima::fastdds::dds::Subscriber& subscriber() { return *subscriber_; }
  [[nodiscard]] Sender& sender() { return sender_; }
  [[nodiscard]] const DiscoveryListener& discovery() const { return discovery_; }
  [[nodiscard]] const DdsParameters& parameters() const { return parameters_; }

  /// EndpointStatus::incompatibility for an endpoint that DDS did not match because of `policy`.
  [[nodiscard]] std::string incompatibility(const std::string& topic, bool own_is_writer,
                                            const msgs::Qos& own,
                                            eprosima::fastdds::dds::QosPolicyId_t policy) const;

  void add(Endpoint* endpoint);
  void remove(Endpoint* endpoint);
  [[nodiscard]] std::vector<EndpointStatus> status() const;
  [[nodiscard]] bool flush(std::chrono::steady_clock::time_point deadline);

  /// Flushes an endpoint before its destruction, within the time that all endpoints share.
  void linger(Endpoint& endpoint);

 private:
  // In this order: Fast DDS calls the listener as long as the participant exists, and the sender
  // writes to endpoints of the participant.
  const DdsParameters parameters_;
  DiscoveryListener discovery_;
  ParticipantHandle participant_;
  eprosima::fastdds::dds::Publisher* publisher_ = nullptr;
  eprosima::fastdds::dds::Subscriber* subscriber_ = nullptr;
  Sender sender_;

  Mutex topics_mutex_;
  std::map<std::string, int> topic_uses_ FURROW_GUARDED_BY(topics_mutex_);

  mutable Mutex endpoints_mutex_;
  std::vector<Endpoint*> endpoints_ FURROW_GUARDED_BY(endpoints_mutex_);

  Mutex linger_mutex_;
  std::chrono::nanoseconds linger_left_ FURROW_GUARDED_BY(linger_mutex_);
};

}  // namespace furrow::dds
