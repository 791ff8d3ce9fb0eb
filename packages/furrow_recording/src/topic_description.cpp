#include "furrow_recording/topic_description.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <limits>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/type_names.hpp"
#include "ros2msg.hpp"
#include "units.hpp"

namespace furrow::recording {
namespace {

constexpr std::size_t kMaxQosText = 1u << 16;
constexpr std::string_view kRosScope = "/msg/";
constexpr std::string_view kIdlScope = "::msg::";
constexpr std::string_view kStaticTransforms = "tf_static";
constexpr char kPublisher[] = "publisher";

// The numbers of rmw's enumerations (rmw/types.h).
constexpr int kReliable = 1;
constexpr int kBestEffort = 2;
constexpr int kTransientLocal = 1;
constexpr int kVolatile = 2;

std::string duration_to_yaml(std::string_view key, Duration duration) {
  const std::int64_t ns =
      duration.count_ns() > 0 ? duration.count_ns() : std::numeric_limits<std::int64_t>::max();
  return "  " + std::string(key) + ":\n    sec: " + std::to_string(ns / kNsPerS) +
         "\n    nsec: " + std::to_string(ns % kNsPerS) + "\n";
}

Duration duration_from_yaml(const YAML::Node& node) {
  if (!node || !node.IsMap()) {
    return {};
  }
  const auto sec = node["sec"].as<std::int64_t>(0);
  const auto nsec = node["nsec"].as<std::int64_t>(0);
  // Unspecified (0) and infinite both mean "not watched".
  if (sec < 0 || nsec < 0 || sec >= std::numeric_limits<std::int64_t>::max() / kNsPerS ||
      nsec >= kNsPerS) {
    return {};
  }
  return Duration::nanoseconds(sec * kNsPerS + nsec);
}

bool is_value(const YAML::Node& node, int number, std::string_view word) {
  return node && node.IsScalar() && (node.as<int>(-1) == number || node.as<std::string>() == word);
}

msgs::Qos profile_from_yaml(const YAML::Node& node) {
  msgs::Qos qos;
  qos.reliability = is_value(node["reliability"], kBestEffort, "best_effort")
                        ? msgs::Reliability::kBestEffort
                        : msgs::Reliability::kReliable;
  qos.durability = is_value(node["durability"], kTransientLocal, "transient_local")
                       ? msgs::Durability::kTransientLocal
                       : msgs::Durability::kVolatile;
  qos.depth = std::clamp(node["depth"].as<int>(0), 0, 100'000);
  qos.deadline = duration_from_yaml(node["deadline"]);
  qos.lifespan = duration_from_yaml(node["lifespan"]);
  qos.liveliness_lease = duration_from_yaml(node["liveliness_lease_duration"]);
  return qos;
}

/// eProsima's format: one map of truth values.
msgs::Qos flags_from_yaml(const YAML::Node& node) {
  msgs::Qos qos;
  qos.reliability = node["reliability"].as<bool>(true) ? msgs::Reliability::kReliable
                                                       : msgs::Reliability::kBestEffort;
  qos.durability = node["durability"].as<bool>(false) ? msgs::Durability::kTransientLocal
                                                      : msgs::Durability::kVolatile;
  qos.depth = 0;
  return qos;
}

}  // namespace

bool TopicDescription::latched() const {
  return is_static_transforms() || std::ranges::any_of(offered_qos, [](const msgs::Qos& qos) {
           return qos.durability == msgs::Durability::kTransientLocal;
         });
}

bool TopicDescription::is_static_transforms() const {
  return name == kStaticTransforms || name.ends_with("/" + std::string(kStaticTransforms));
}

std::string schema_name(const TopicDescription& topic) {
  const std::size_t scope = topic.type_name.find(kRosScope);
  if (topic.schema_encoding != "omgidl" || scope == std::string::npos) {
    return topic.type_name;
  }
  return topic.type_name.substr(0, scope) + std::string(kIdlScope) +
         topic.type_name.substr(scope + kRosScope.size());
}

std::string topic_in_file(std::string_view name) {
  return name.starts_with("//") ? std::string(name.substr(2)) : "/" + std::string(name);
}

std::string topic_from_file(std::string_view name) {
  for (const std::string_view prefix : {"/", "rt/"}) {
    if (name.starts_with(prefix)) {
      return std::string(name.substr(prefix.size()));
    }
  }
  return "//" + std::string(name);
}

TopicDescription describe_topic(std::string_view name, std::string_view type_name,
                                const std::vector<msgs::Qos>& offered_qos, SchemaStyle style) {
  TopicDescription topic;
  topic.name = name;
  topic.type_name = msgs::ros_type_name(type_name);
  topic.offered_qos = offered_qos;
  for (const msgs::MessageType* type : msgs::all_message_types()) {
    if (type->ros_name != topic.type_name) {
      continue;
    }
    auto text = ros2msg_from_idl(type->idl, type->ros_name);
    const bool as_msg = style == SchemaStyle::kRos2msg && text.ok();
    topic.schema_encoding = as_msg ? "ros2msg" : "omgidl";
    topic.schema_text = as_msg ? *text : std::string(type->idl);
  }
  return topic;
}

std::string qos_to_yaml(const std::vector<msgs::Qos>& profiles) {
  std::string yaml;
  for (const msgs::Qos& qos : profiles) {
    const bool reliable = qos.reliability == msgs::Reliability::kReliable;
    const bool latched = qos.durability == msgs::Durability::kTransientLocal;
    yaml += "- history: 1\n  depth: " + std::to_string(qos.depth) +
            "\n  reliability: " + std::to_string(reliable ? kReliable : kBestEffort) +
            "\n  durability: " + std::to_string(latched ? kTransientLocal : kVolatile) + "\n" +
            duration_to_yaml("deadline", qos.deadline) +
            duration_to_yaml("lifespan", qos.lifespan) + "  liveliness: 1\n" +
            duration_to_yaml("liveliness_lease_duration", qos.liveliness_lease) +
            "  avoid_ros_namespace_conventions: false\n";
  }
  return yaml;
}

Result<std::vector<msgs::Qos>> qos_from_yaml(const std::string& yaml) {
  if (yaml.size() > kMaxQosText) {
    return Error{ErrorCode::kParse, "the QoS text is too long"};
  }
  try {
    const YAML::Node root = YAML::Load(yaml);
    std::vector<msgs::Qos> profiles;
    if (root.IsMap()) {
      const YAML::Node node = root["reliability"];
      const bool flags =
          node && (node.as<std::string>("") == "true" || node.as<std::string>("") == "false");
      profiles.push_back(flags ? flags_from_yaml(root) : profile_from_yaml(root));
    } else if (root.IsSequence()) {
      for (const YAML::Node& node : root) {
        if (!node.IsMap()) {
          return Error{ErrorCode::kParse, "a QoS profile is no map"};
        }
        profiles.push_back(profile_from_yaml(node));
      }
    } else if (!root.IsNull()) {
      return Error{ErrorCode::kParse, "QoS profiles are neither a list nor a map"};
    }
    return profiles;
  } catch (const YAML::Exception& failure) {
    return Error{ErrorCode::kParse, std::string("malformed QoS profiles: ") + failure.what()};
  }
}

mcap::StringMap channel_metadata(const TopicDescription& topic) {
  const bool reliable = std::all_of(
      topic.offered_qos.begin(), topic.offered_qos.end(),
      [](const msgs::Qos& qos) { return qos.reliability == msgs::Reliability::kReliable; });
  const std::string flags = std::string("reliability: ") + (reliable ? "true" : "false") +
                            "\ndurability: " + (topic.latched() ? "true" : "false") +
                            "\nownership: false\nkeyed: false\n";
  const bool ros2 = topic.type_name.find(kRosScope) != std::string::npos;
  mcap::StringMap metadata = {{"offered_qos_profiles", qos_to_yaml(topic.offered_qos)},
                              {"qos", flags},
                              {"ros2-types", ros2 ? "true" : "false"}};
  if (!topic.publisher.empty()) {
    metadata[kPublisher] = topic.publisher;
  }
  return metadata;
}

TopicDescription describe_channel(const mcap::Channel& channel, const mcap::Schema* schema) {
  const auto value = [&channel](const char* key) {
    const auto at = channel.metadata.find(key);
    return at == channel.metadata.end() ? std::string() : at->second;
  };
  TopicDescription topic;
  topic.name = topic_from_file(channel.topic);
  topic.message_encoding = channel.message_encoding;
  topic.publisher = value(kPublisher);
  if (schema != nullptr) {
    topic.type_name = msgs::ros_type_name(schema->name);
    topic.schema_encoding = schema->encoding;
    topic.schema_text = schema->data;
    const std::size_t scope = topic.type_name.find(kIdlScope);
    if (scope != std::string::npos && value("ros2-types") == "true") {
      topic.type_name.replace(scope, kIdlScope.size(), kRosScope);
    }
  }
  for (const char* key : {"offered_qos_profiles", "qos"}) {
    if (auto profiles = qos_from_yaml(value(key)); profiles && topic.offered_qos.empty()) {
      topic.offered_qos = std::move(*profiles);
    }
  }
  return topic;
}

}  // namespace furrow::recording
