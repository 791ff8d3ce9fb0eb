#include "participant.hpp"

#include <algorithm>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <mutex>

#include "cdr_type.hpp"
#include "furrow_dds/shared_memory_need.hpp"
#include "library_log.hpp"
#include "network_interfaces.hpp"
#include "participant_qos.hpp"

namespace furrow::dds {

namespace fdds = eprosima::fastdds::dds;

namespace {

ParticipantHandle create_participant(const DdsParameters& parameters, DiscoveryListener& listener) {
  const fdds::DomainParticipantQos qos = participant_qos(parameters);
  take_over_library_log();
  check_shared_memory(parameters, 1);
  if (std::ranges::find(parameters.transports, "udp") != parameters.transports.end()) {
    wait_for_interfaces(parameters.interfaces, std::chrono::seconds(5));
  }
  ParticipantHandle participant(fdds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<fdds::DomainId_t>(parameters.domain_id), qos, &listener,
      fdds::StatusMask::none()));
  if (participant == nullptr) {
    throw ConfigError("DDS participant refused in domain " + std::to_string(parameters.domain_id) +
                      ": is there an interface with the given address, and memory in /dev/shm?");
  }
  return participant;
}

}  // namespace

void IncompatibilityLog::add(const std::string& detail) {
  const MutexLock lock(mutex_);
  ++count_;
  last_ = detail;
}

void IncompatibilityLog::add_to(EndpointStatus& status) const {
  const MutexLock lock(mutex_);
  status.incompatible = count_;
  status.incompatibility = last_;
}

void ParticipantDeleter::operator()(fdds::DomainParticipant* participant) const {
  participant->set_listener(nullptr);
  participant->delete_contained_entities();
  fdds::DomainParticipantFactory::get_instance()->delete_participant(participant);
}

Participant::Participant(const DdsParameters& parameters)
    : parameters_(parameters),
      participant_(create_participant(parameters_, discovery_)),
      publisher_(participant_->create_publisher(fdds::PUBLISHER_QOS_DEFAULT)),
      subscriber_(participant_->create_subscriber(fdds::SUBSCRIBER_QOS_DEFAULT)),
      sender_(static_cast<std::size_t>(parameters.bulk_threshold_kb * 1000)),
      linger_left_(Duration::seconds(parameters.linger_s).count_ns()) {
  if (publisher_ == nullptr || subscriber_ == nullptr) {
    throw ConfigError("DDS refused a publisher or subscriber in domain " +
                      std::to_string(parameters.domain_id));
  }
  ProcessInfo own;
  own.guid = to_guid(participant_->guid());
  own.name = parameters.process_name;
  read_user_data(process_user_data(), own);
  own.own = true;
  discovery_.set_own(own);
}

Participant::TopicUse::TopicUse(Participant& participant, const std::string& topic,
                                const std::string& type_name)
    : participant_(participant) {
  const std::string name = dds_topic_name(topic);
  const MutexLock lock(participant_.topics_mutex_);
  if (auto* known = participant_.participant_->lookup_topicdescription(name)) {
    if (known->get_type_name() != type_name) {
      throw ConfigError("topic " + topic + " has type " + known->get_type_name() + ", not " +
                        type_name);
    }
    topic_ = static_cast<fdds::Topic*>(known);
  } else {
    if (participant_.participant_->find_type(type_name).empty()) {
      participant_.participant_->register_type(fdds::TypeSupport(new CdrType(type_name)));
    }
    topic_ = participant_.participant_->create_topic(name, type_name, fdds::TOPIC_QOS_DEFAULT);
    if (topic_ == nullptr) {
      throw ConfigError("topic " + topic + " of type '" + type_name + "' refused by DDS");
    }
  }
  ++participant_.topic_uses_[name];
}

Participant::TopicUse::~TopicUse() {
  const MutexLock lock(participant_.topics_mutex_);
  const auto use = participant_.topic_uses_.find(topic_->get_name());
  if (--use->second == 0) {
    participant_.topic_uses_.erase(use);
    participant_.participant_->delete_topic(topic_);
  }
}

bool Participant::is_own(const eprosima::fastrtps::rtps::InstanceHandle_t& handle) const {
  return eprosima::fastrtps::rtps::iHandle2GUID(handle).guidPrefix ==
         participant_->guid().guidPrefix;
}

std::string Participant::incompatibility(const std::string& topic, bool own_is_writer,
                                         const msgs::Qos& own, fdds::QosPolicyId_t policy) const {
  const std::string text = discovery_.incompatibility(topic, own_is_writer, own);
  return text.empty() ? "DDS QoS policy " + std::to_string(policy) : text;
}

void Participant::add(Endpoint* endpoint) {
  const MutexLock lock(endpoints_mutex_);
  endpoints_.push_back(endpoint);
}

void Participant::remove(Endpoint* endpoint) {
  const MutexLock lock(endpoints_mutex_);
  std::erase(endpoints_, endpoint);
}

std::vector<EndpointStatus> Participant::status() const {
  const MutexLock lock(endpoints_mutex_);
  std::vector<EndpointStatus> out;
  out.reserve(endpoints_.size());
  for (const Endpoint* endpoint : endpoints_) {
    out.push_back(endpoint->status());
  }
  return out;
}

bool Participant::flush(std::chrono::steady_clock::time_point deadline) {
  const MutexLock lock(endpoints_mutex_);
  return std::all_of(endpoints_.begin(), endpoints_.end(),
                     [&](Endpoint* endpoint) { return endpoint->flush(deadline); });
}

void Participant::linger(Endpoint& endpoint) {
  const MutexLock lock(linger_mutex_);
  const auto start = std::chrono::steady_clock::now();
  [[maybe_unused]] const bool delivered = endpoint.flush(start + linger_left_);
  linger_left_ -=
      std::min<std::chrono::nanoseconds>(linger_left_, std::chrono::steady_clock::now() - start);
}

}  // namespace furrow::dds
