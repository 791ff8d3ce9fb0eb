#include "furrow_launch/external_inputs.hpp"

#include <algorithm>
#include <set>

#include "furrow_graph/graph_check.hpp"

namespace furrow::launch {
namespace {

constexpr int kSilentCalls = 2;
constexpr int kRepeatCalls = 10;

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// The writers of other processes on a topic whose type is not the wanted one. DDS does not match
/// them, and reports nothing.
std::string other_type(const dds::DiscoverySnapshot& domain, const ExternalInput& input) {
  for (const dds::TopicInfo& topic : domain.topics) {
    if (topic.name != input.topic) continue;
    for (const dds::EndpointInfo& writer : topic.writers) {
      if (!writer.own && writer.type_name != input.type) return writer.type_name;
    }
  }
  return {};
}

std::string cause_of(const ExternalInput& input, const dds::EndpointStatus* endpoint,
                     const dds::DiscoverySnapshot& domain) {
  if (endpoint != nullptr && endpoint->peers > 0) {
    return "a writer was found, but no message arrived; does the driver run?";
  }
  if (const std::string type = other_type(domain, input); !type.empty()) {
    return "a writer was found with type " + type + " instead of " + input.type;
  }
  if (endpoint != nullptr && endpoint->incompatible > 0) {
    return "a writer was found with an incompatible QoS, " + endpoint->incompatibility;
  }
  return "no writer was found; start the driver, or remap its topic (" + input.ros_type + ")";
}

std::string effect_of(const ExternalInput& input) {
  return joined(input.readers) +
         (input.required ? " cannot work without it" : " works without it, with less accuracy");
}

}  // namespace

std::vector<ExternalInput> external_inputs(const graph::GraphSpec& graph,
                                           graph::Registry& registry) {
  const std::set<std::string> named(graph.external.begin(), graph.external.end());
  std::map<std::string, ExternalInput> inputs;
  std::set<std::string> published;
  for (const graph::ComponentSpec& component : graph.components) {
    const graph::Description& description =
        registry.find(component.class_name, component.where).description;
    for (const graph::PortInfo& port : description.outputs()) {
      published.insert(graph::resolved_topic(component, *port.topic));
    }
    for (const graph::PortInfo& port : description.inputs()) {
      const std::string topic = graph::resolved_topic(component, *port.topic);
      const bool required = port.need == graph::Need::kRequired;
      if (!required && (!named.contains(topic) || port.topic->rate_hz == 0.0)) continue;
      ExternalInput& input = inputs[topic];
      if (input.readers.empty()) {
        input.port = port.topic->name;
        input.qos = port.topic->qos;
      }
      input.topic = topic;
      input.type = port.topic->type->dds_name;
      input.ros_type = port.topic->type->ros_name;
      input.required = input.required || required;
      input.readers.push_back(component.name);
    }
  }
  std::vector<ExternalInput> list;
  for (auto& [topic, input] : inputs) {
    if (!published.contains(topic)) list.push_back(std::move(input));
  }
  return list;
}

graph::Health InputWatch::look(const std::vector<dds::EndpointStatus>& endpoints,
                               const dds::DiscoverySnapshot& domain) {
  graph::Health health;
  std::string text;
  for (const ExternalInput& input : inputs_) {
    const auto endpoint = std::ranges::find_if(endpoints, [&](const dds::EndpointStatus& status) {
      return !status.writer && status.topic == input.topic;
    });
    const bool known = endpoint != endpoints.end();
    if (known && endpoint->counters.messages > 0) continue;
    ++health.counters["inputs_not_heard"];
    text += (text.empty() ? "not heard: " : "; ") + input.topic + ": " +
            cause_of(input, known ? &*endpoint : nullptr, domain) + " (" + effect_of(input) + ")";
  }
  ++calls_;
  if (calls_ > kSilentCalls && !text.empty() &&
      (text != last_ || (calls_ - kSilentCalls) % kRepeatCalls == 1)) {
    health.level = graph::HealthLevel::kWarn;
    health.message = text;
    last_ = text;
  }
  return health;
}

}  // namespace furrow::launch
