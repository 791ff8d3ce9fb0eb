#include "discovery_listener.hpp"

#include <fastdds/rtps/participant/ParticipantDiscoveryInfo.h>
#include <fastdds/rtps/reader/ReaderDiscoveryInfo.h>
#include <fastdds/rtps/writer/WriterDiscoveryInfo.h>

#include <algorithm>
#include <set>

#include "endpoint_qos.hpp"
#include "participant_qos.hpp"

namespace furrow::dds {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

constexpr std::string_view kTopicPrefix = "rt/";
constexpr std::size_t kPrefixBytes = 12;

bool same_process(const Guid& a, const Guid& b) {
  return std::equal(a.bytes.begin(), a.bytes.begin() + kPrefixBytes, b.bytes.begin());
}

Guid participant_of(const Guid& endpoint) {
  Guid guid = endpoint;
  constexpr std::array<std::uint8_t, 4> kParticipantEntity = {0, 0, 1, 0xC1};
  std::copy(kParticipantEntity.begin(), kParticipantEntity.end(),
            guid.bytes.begin() + kPrefixBytes);
  return guid;
}

template <class EndpointQos>
msgs::Qos from_dds_qos(const EndpointQos& in) {
  msgs::Qos qos;
  qos.reliability = in.m_reliability.kind == fdds::RELIABLE_RELIABILITY_QOS
                        ? msgs::Reliability::kReliable
                        : msgs::Reliability::kBestEffort;
  // The persistent kinds include transient local.
  qos.durability = in.m_durability.kind == fdds::VOLATILE_DURABILITY_QOS
                       ? msgs::Durability::kVolatile
                       : msgs::Durability::kTransientLocal;
  qos.depth = 0;
  qos.deadline = from_dds(in.m_deadline.period);
  qos.liveliness_lease = from_dds(in.m_liveliness.lease_duration);
  qos.lifespan = from_dds(in.m_lifespan.duration);
  return qos;
}

}  // namespace

Guid to_guid(const rtps::GUID_t& guid) {
  Guid out;
  std::copy_n(guid.guidPrefix.value, kPrefixBytes, out.bytes.begin());
  std::copy_n(guid.entityId.value, out.bytes.size() - kPrefixBytes,
              out.bytes.begin() + kPrefixBytes);
  return out;
}

std::string dds_topic_name(const std::string& topic) {
  return topic.starts_with("//") ? topic.substr(2) : std::string(kTopicPrefix) + topic;
}

std::string topic_name(const std::string& dds_name) {
  return dds_name.starts_with(kTopicPrefix) ? dds_name.substr(kTopicPrefix.size())
                                            : "//" + dds_name;
}

void DiscoveryListener::set_own(const ProcessInfo& own) {
  const MutexLock lock(mutex_);
  own_ = own.guid;
  processes_[own.guid] = own;
  ++version_;
}

void DiscoveryListener::on_participant_discovery(fdds::DomainParticipant*,
                                                 rtps::ParticipantDiscoveryInfo&& info) {
  const Guid guid = to_guid(info.info.m_guid);
  const MutexLock lock(mutex_);
  if (guid == own_) {
    return;
  }
  if (info.status == rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT ||
      info.status == rtps::ParticipantDiscoveryInfo::CHANGED_QOS_PARTICIPANT) {
    if (processes_.size() >= kMaxEntries && !processes_.contains(guid)) {
      return;
    }
    ProcessInfo& process = processes_[guid];
    process.guid = guid;
    process.name = info.info.m_participantName.to_string();
    const auto& bytes = info.info.m_userData.data_vec();
    read_user_data({bytes.begin(), bytes.end()}, process);
  } else {
    processes_.erase(guid);
    std::erase_if(endpoints_, [&](const auto& entry) { return same_process(entry.first, guid); });
  }
  ++version_;
}

template <class ProxyData>
void DiscoveryListener::update(const ProxyData& data, bool writer, bool removed) {
  const Guid guid = to_guid(data.guid());
  const MutexLock lock(mutex_);
  if (removed) {
    endpoints_.erase(guid);
  } else if (endpoints_.size() < kMaxEntries || endpoints_.contains(guid)) {
    Endpoint& endpoint = endpoints_[guid];
    endpoint.dds_topic = data.topicName().to_string();
    endpoint.writer = writer;
    endpoint.info.guid = guid;
    endpoint.info.process = participant_of(guid);
    endpoint.info.own = same_process(guid, own_);
    endpoint.info.keyed = data.topicKind() == rtps::WITH_KEY;
    endpoint.info.type_name = data.typeName().to_string();
    endpoint.info.qos = from_dds_qos(data.m_qos);
  }
  ++version_;
}

void DiscoveryListener::on_subscriber_discovery(fdds::DomainParticipant*,
                                                rtps::ReaderDiscoveryInfo&& info) {
  update(info.info, false, info.status == rtps::ReaderDiscoveryInfo::REMOVED_READER);
}

void DiscoveryListener::on_publisher_discovery(fdds::DomainParticipant*,
                                               rtps::WriterDiscoveryInfo&& info) {
  update(info.info, true, info.status == rtps::WriterDiscoveryInfo::REMOVED_WRITER);
}

std::uint64_t DiscoveryListener::version() const {
  const MutexLock lock(mutex_);
  return version_;
}

std::optional<msgs::Reliability> DiscoveryListener::reliability_of(const Guid& endpoint) const {
  const MutexLock lock(mutex_);
  const auto it = endpoints_.find(endpoint);
  if (it == endpoints_.end()) return std::nullopt;
  return it->second.info.qos.reliability;
}

std::string DiscoveryListener::incompatibility(const std::string& topic, bool own_is_writer,
                                               const msgs::Qos& own) const {
  const std::string name = dds_topic_name(topic);
  const MutexLock lock(mutex_);
  for (const auto& [guid, endpoint] : endpoints_) {
    if (endpoint.info.own || endpoint.writer == own_is_writer || endpoint.dds_topic != name) {
      continue;
    }
    const msgs::Qos& other = endpoint.info.qos;
    const std::string text =
        own_is_writer ? msgs::incompatibility(own, other) : msgs::incompatibility(other, own);
    if (text.empty()) continue;
    const auto process = processes_.find(endpoint.info.process);
    return process == processes_.end() ? text : text + " (process '" + process->second.name + "')";
  }
  return {};
}

DiscoverySnapshot DiscoveryListener::snapshot() const {
  DiscoverySnapshot out;
  std::map<std::string, TopicInfo> topics;
  std::map<std::string, std::set<std::string>> type_names;
  {
    const MutexLock lock(mutex_);
    out.version = version_;
    for (const auto& [guid, process] : processes_) {
      out.processes.push_back(process);
    }
    for (const auto& [guid, endpoint] : endpoints_) {
      const std::string name = topic_name(endpoint.dds_topic);
      TopicInfo& topic = topics[name];
      (endpoint.writer ? topic.writers : topic.readers).push_back(endpoint.info);
      type_names[name].insert(endpoint.info.type_name);
    }
  }
  std::stable_sort(out.processes.begin(), out.processes.end(),
                   [](const ProcessInfo& a, const ProcessInfo& b) { return a.name < b.name; });
  for (auto& [name, topic] : topics) {
    topic.name = name;
    topic.type_names.assign(type_names[name].begin(), type_names[name].end());
    out.topics.push_back(std::move(topic));
  }
  return out;
}

}  // namespace furrow::dds
