#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "furrow_msgs/qos.hpp"

namespace furrow::dds {

/// The identity of a participant or endpoint: RTPS GUID, 12 bytes prefix and 4 bytes entity.
struct Guid {
  std::array<std::uint8_t, 16> bytes{};
  auto operator<=>(const Guid&) const = default;
};

/// A process in the domain.
struct ProcessInfo {
  Guid guid;             ///< of its participant
  std::string name;      ///< DdsParameters::process_name, or the name of a foreign participant
  std::string host;      ///< host name; empty for foreign participants
  std::int64_t pid = 0;  ///< 0 for foreign participants
  bool own = false;      ///< this transport's own participant
};

/// A writer or reader as its participant announces it.
struct EndpointInfo {
  Guid guid;
  Guid process;  ///< ProcessInfo::guid
  bool own = false;
  bool keyed = false;  ///< its type has keys, which RawReader cannot read
  std::string type_name;
  /// DDS does not announce the depth, which is 0.
  msgs::Qos qos;
};

struct TopicInfo {
  /// Without "rt/". A foreign topic without that prefix is "//NAME".
  std::string name;
  std::vector<std::string> type_names;  ///< distinct, sorted; more than one is an error
  std::vector<EndpointInfo> writers;
  std::vector<EndpointInfo> readers;
};

/// The processes and topics of the domain at one moment, this process included.
struct DiscoverySnapshot {
  std::uint64_t version = 0;           ///< grows with every change
  std::vector<ProcessInfo> processes;  ///< by name
  std::vector<TopicInfo> topics;       ///< by name
};

}  // namespace furrow::dds
