#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/result.hpp"
#include "furrow_msgs/qos.hpp"
#include "furrow_recording/mcap_types.hpp"

namespace furrow::recording {

/// What a recording says of a topic. In the graph and here topics are named without a leading "/",
/// in files with one (as ROS 2 names them); DDS topics outside "rt/" are "//NAME" here and "NAME"
/// in files.
struct TopicDescription {
  std::string name;
  std::string type_name;        ///< "sensor_msgs/msg/Image"
  std::string schema_encoding;  ///< "omgidl", "ros2msg"; empty: the type's text is not known
  std::string schema_text;
  std::string message_encoding = "cdr";
  std::vector<msgs::Qos> offered_qos;  ///< one per writer that was known, not repeated

  /// A late joiner must get its last message: one of its writers was TRANSIENT_LOCAL.
  [[nodiscard]] bool latched() const;
};

[[nodiscard]] std::string topic_in_file(std::string_view name);
[[nodiscard]] std::string topic_from_file(std::string_view name);

enum class SchemaStyle : std::uint8_t {
  kRos2msg,  ///< what ROS 2's own tools and viewers read
  kOmgidl,   ///< the IDL text as it is
};

/// The description of a topic of this type, with the type's text when Furrow was built with it.
[[nodiscard]] TopicDescription describe_topic(std::string_view name, std::string_view type_name,
                                              const std::vector<msgs::Qos>& offered_qos,
                                              SchemaStyle style);
/// How the type is named in a file's schema: "pkg/msg/Type" beside ros2msg, "pkg::msg::Type" beside
/// omgidl, since readers look it up in the IDL by that name.
[[nodiscard]] std::string schema_name(const TopicDescription& topic);

/// As rosbag2 writes `offered_qos_profiles`: a YAML list with the numbers of rmw's enumerations.
[[nodiscard]] std::string qos_to_yaml(const std::vector<msgs::Qos>& profiles);
/// Reads that, and the form with words in place of numbers. kParse when it is neither.
[[nodiscard]] Result<std::vector<msgs::Qos>> qos_from_yaml(const std::string& yaml);

/// Channel metadata `offered_qos_profiles`, `qos` (as eProsima's recorder) and `ros2-types`.
[[nodiscard]] mcap::StringMap channel_metadata(const TopicDescription& topic);
/// What a file's channel says. Unreadable QoS metadata count as none.
[[nodiscard]] TopicDescription describe_channel(const mcap::Channel& channel,
                                                const mcap::Schema* schema);

}  // namespace furrow::recording
