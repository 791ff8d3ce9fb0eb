#pragma once

#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/Locator.h>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <string>

#include "furrow_dds/dds_parameters.hpp"

namespace furrow::dds {

/// Throws ConfigError on parameters out of range and malformed addresses.
[[nodiscard]] eprosima::fastdds::dds::DomainParticipantQos participant_qos(
    const DdsParameters& parameters);

/// Where a reader of this type ("sensor_msgs::msg::dds_::Image_") listens; empty: where its
/// participant does. One with locators of its own must get them anew at each call.
[[nodiscard]] eprosima::fastdds::rtps::LocatorList reader_locators(const DdsParameters& parameters,
                                                                   const std::string& type_name);

inline constexpr std::uint32_t kDiscoveryServerPort = 11811;
inline constexpr std::int64_t kMaxDiscoveryServers = 256;

/// "A.B.C.D" or "A.B.C.D:PORT". Throws ConfigError.
[[nodiscard]] eprosima::fastrtps::rtps::Locator_t udp_locator(const std::string& address,
                                                              std::uint32_t default_port);
[[nodiscard]] eprosima::fastrtps::rtps::GuidPrefix_t discovery_server_prefix(std::uint8_t id);

/// What a participant of ours tells of its process, as user data "key=value;".
[[nodiscard]] std::string process_user_data();
/// The value behind `key`, or empty.
[[nodiscard]] std::string user_data_value(const std::string& user_data, const std::string& key);

}  // namespace furrow::dds
