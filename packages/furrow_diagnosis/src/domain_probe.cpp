#include "furrow_diagnosis/domain_probe.hpp"

#include <algorithm>

#include "furrow_msgs/type_names.hpp"

namespace furrow::diagnosis {
namespace {

std::string process_of(const dds::EndpointInfo& writer, const dds::DiscoverySnapshot& domain) {
  const auto it = std::ranges::find(domain.processes, writer.process, &dds::ProcessInfo::guid);
  if (it == domain.processes.end()) return "unknown";
  return it->host.empty() ? it->name : it->name + " on " + it->host;
}

bool has_foreign_writer(const dds::TopicInfo& topic, const std::string& type) {
  return std::ranges::any_of(topic.writers, [&](const dds::EndpointInfo& writer) {
    return !writer.own && writer.type_name == type;
  });
}

}  // namespace

void add_writers(TopicObservation& topic, const launch::ExternalInput& input,
                 const std::vector<SensorInput>& inputs, const dds::DiscoverySnapshot& domain) {
  constexpr std::size_t kMaxAlternatives = 5;
  for (const dds::TopicInfo& found : domain.topics) {
    if (found.name == input.topic) {
      for (const dds::EndpointInfo& writer : found.writers) {
        if (writer.own) continue;
        topic.writers.push_back({process_of(writer, domain), msgs::ros_type_name(writer.type_name),
                                 msgs::incompatibility(writer.qos, input.qos)});
      }
      continue;
    }
    const bool taken = std::ranges::any_of(
        inputs, [&](const SensorInput& other) { return other.input.topic == found.name; });
    const bool other_name = found.name == "//" + input.topic;
    if (!taken && topic.alternatives.size() < kMaxAlternatives &&
        (other_name || has_foreign_writer(found, input.type))) {
      topic.alternatives.push_back(found.name);
    }
  }
}

DomainProbe::DomainProbe(dds::DdsTransport& transport, const SensorSetup& setup)
    : transport_(transport), inputs_(setup.inputs), observer_(setup) {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const launch::ExternalInput& input = inputs_[i].input;
    readers_.push_back(transport.make_raw_reader(
        input.topic, input.type, input.qos, [this, i](const dds::RawMessage& message) {
          const std::lock_guard lock(mutex_);
          observer_.take(i, message.payload, message.source_time, message.reception_time);
        }));
  }
}

Observations DomainProbe::observations(double seconds) const {
  const dds::DiscoverySnapshot domain = transport_.discovery();
  Observations seen;
  {
    const std::lock_guard lock(mutex_);
    seen = observer_.observations();
  }
  seen.seconds = seconds;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    add_writers(seen.topics[i], inputs_[i].input, inputs_, domain);
  }
  return seen;
}

}  // namespace furrow::diagnosis
