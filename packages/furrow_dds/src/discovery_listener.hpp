#pragma once

#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <map>
#include <optional>
#include <string>

#include "furrow_core/mutex.hpp"
#include "furrow_dds/discovery.hpp"

namespace furrow::dds {

[[nodiscard]] Guid to_guid(const eprosima::fastrtps::rtps::GUID_t& guid);

/// Converts between "NAME" and "rt/NAME". A name that begins with "//" has no prefix in DDS.
[[nodiscard]] std::string dds_topic_name(const std::string& topic);
[[nodiscard]] std::string topic_name(const std::string& dds_name);

/// Records the discovered processes and endpoints. Thread-safe. Bounded: entries beyond kMaxEntries
/// are left out.
class DiscoveryListener final : public eprosima::fastdds::dds::DomainParticipantListener {
 public:
  static constexpr std::size_t kMaxEntries = 10000;

  void set_own(const ProcessInfo& own);
  [[nodiscard]] DiscoverySnapshot snapshot() const;
  [[nodiscard]] std::uint64_t version() const;
  /// The reliability that a discovered endpoint announced.
  [[nodiscard]] std::optional<msgs::Reliability> reliability_of(const Guid& endpoint) const;
  /// Why an endpoint of another process does not match ours: the policies with both values, and the
  /// process. Empty: no announced policy explains it.
  [[nodiscard]] std::string incompatibility(const std::string& topic, bool own_is_writer,
                                            const msgs::Qos& own) const;

  void on_participant_discovery(eprosima::fastdds::dds::DomainParticipant*,
                                eprosima::fastrtps::rtps::ParticipantDiscoveryInfo&& info) override;
  void on_subscriber_discovery(eprosima::fastdds::dds::DomainParticipant*,
                               eprosima::fastrtps::rtps::ReaderDiscoveryInfo&& info) override;
  void on_publisher_discovery(eprosima::fastdds::dds::DomainParticipant*,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;

 private:
  struct Endpoint {
    std::string dds_topic;
    bool writer = false;
    EndpointInfo info;
  };
  template <class ProxyData>
  void update(const ProxyData& data, bool writer, bool removed);

  mutable Mutex mutex_;
  std::uint64_t version_ FURROW_GUARDED_BY(mutex_) = 0;
  Guid own_ FURROW_GUARDED_BY(mutex_);
  std::map<Guid, ProcessInfo> processes_ FURROW_GUARDED_BY(mutex_);
  std::map<Guid, Endpoint> endpoints_ FURROW_GUARDED_BY(mutex_);
};

}  // namespace furrow::dds
