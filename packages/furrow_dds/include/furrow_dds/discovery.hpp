#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <string>
#include <vector>

#include "furrow_msgs/qos.hpp"

namespace furrow::dds {

/// A participant's or endpoint's identity in DDS (RTPS GUID: 12 bytes prefix, 4 entity).
struct Guid {
  std::array<std::uint8_t, 16> bytes{};
  auto operator<=>(const Guid&) const = default;
};

/// A process that takes part in the domain.
struct ProcessInfo {
  Guid guid;         ///< of its participant
  std::string name;  ///< DdsParameters::process_name, or what a foreign participant calls itself
  std::string host;  ///< host name; empty for foreign participants
  std::int64_t pid = 0;  ///< 0 for foreign participants
  bool own = false;      ///< this transport's own participant
};

/// A writer or reader as its participant announces it.
struct EndpointInfo {
  Guid guid;
  Guid process;  ///< ProcessInfo::guid
  bool own = false;
  bool keyed = false;  ///< made for a type with keys; RawReader cannot read those
  std::string type_name;
  /// `depth` is not announced by DDS and is 0.
  msgs::Qos qos;
};

struct TopicInfo {
  /// Without "rt/"; a foreign topic that lacks the prefix keeps its name behind a leading "//".
  std::string name;
  std::vector<std::string> type_names;  ///< distinct, sorted; more than one is a wiring fault
  std::vector<EndpointInfo> writers;
  std::vector<EndpointInfo> readers;
};

/// What is known of the domain at one moment, this process included.
struct DiscoverySnapshot {
  std::uint64_t version = 0;           ///< grows with every change
  std::vector<ProcessInfo> processes;  ///< by name
  std::vector<TopicInfo> topics;       ///< by name
};

}  // namespace furrow::dds
