#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_msgs/qos.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::recording {

/// What a recording says about a topic. In the graph and here topics are named without a leading
/// "/", in files with one (as in ROS 2). DDS topics outside "rt/" are "//NAME" here and "NAME" in
/// files.
struct TopicDescription {
  std::string name;
  std::string type_name;        ///< "sensor_msgs/msg/Image"
  std::string schema_encoding;  ///< "omgidl", "ros2msg"; empty: the type's text is not known
  std::string schema_text;
  std::string message_encoding = "cdr";
  std::vector<msgs::Qos> offered_qos;  ///< one per writer that was known
  /// Which writer the channel is of, where a topic has a channel per writer. Empty: all writers.
  std::string publisher;

  /// Late joiners get its last messages: a writer was TRANSIENT_LOCAL, or it is tf_static.
  [[nodiscard]] bool latched() const;
  /// Named "tf_static", in any namespace: latched by convention, with several publishers.
  [[nodiscard]] bool is_static_transforms() const;
};

[[nodiscard]] std::string topic_in_file(std::string_view name);
[[nodiscard]] std::string topic_from_file(std::string_view name);

enum class SchemaStyle : std::uint8_t {
  kRos2msg,  ///< what ROS 2's own tools and viewers read
  kOmgidl,   ///< the IDL text as it is
};

/// Describes a topic of this type, with the type's text when Furrow was built with it.
[[nodiscard]] TopicDescription describe_topic(std::string_view name, std::string_view type_name,
                                              const std::vector<msgs::Qos>& offered_qos,
                                              SchemaStyle style);
/// The type's name in a file's schema: "pkg/msg/Type" with ros2msg. "pkg::msg::Type" with omgidl:
/// readers look that name up in the IDL.
[[nodiscard]] std::string schema_name(const TopicDescription& topic);

/// `offered_qos_profiles` as rosbag2 writes it: a YAML list with the numbers of rmw's enumerations.
[[nodiscard]] std::string qos_to_yaml(const std::vector<msgs::Qos>& profiles);
/// Reads `offered_qos_profiles` with numbers or with words, and eProsima's `qos`. kParse for
/// anything else.
[[nodiscard]] Result<std::vector<msgs::Qos>> qos_from_yaml(const std::string& yaml);

/// Channel metadata: `offered_qos_profiles` as rosbag2, `qos` and `ros2-types` as eProsima's
/// recorder, and `publisher`.
[[nodiscard]] mcap::StringMap channel_metadata(const TopicDescription& topic);
/// Describes a channel of a file. Unreadable QoS metadata count as none.
[[nodiscard]] TopicDescription describe_channel(const mcap::Channel& channel,
                                                const mcap::Schema* schema);

}  // namespace furrow::recording
