#pragma once

#include <fastdds/rtps/common/Guid.h>
#include <fastdds/rtps/common/Locator.h>

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <string>

#include "furrow_dds/dds_parameters.hpp"
#include "furrow_dds/discovery.hpp"

namespace furrow::dds {

/// Throws ConfigError if a parameter is out of range or an address is malformed.
[[nodiscard]] eprosima::fastdds::dds::DomainParticipantQos participant_qos(
    const DdsParameters& parameters);

/// The locators of a reader of this type ("sensor_msgs::msg::dds_::Image_"); empty: those of its
/// participant. Each reader needs its own call, because its ports are unique.
[[nodiscard]] eprosima::fastdds::rtps::LocatorList reader_locators(const DdsParameters& parameters,
                                                                   const std::string& type_name);

inline constexpr std::uint32_t kDiscoveryServerPort = 11811;
inline constexpr std::int64_t kMaxDiscoveryServers = 256;

/// "A.B.C.D" or "A.B.C.D:PORT". Throws ConfigError.
[[nodiscard]] eprosima::fastrtps::rtps::Locator_t udp_locator(const std::string& address,
                                                              std::uint32_t default_port);
[[nodiscard]] eprosima::fastrtps::rtps::GuidPrefix_t discovery_server_prefix(std::uint8_t id);

/// The user data of our participants, "key=value;": host and process id.
[[nodiscard]] std::string process_user_data();
/// Sets host and pid from the user data of a participant, where it has them.
void read_user_data(const std::string& user_data, ProcessInfo& process);

}  // namespace furrow::dds
