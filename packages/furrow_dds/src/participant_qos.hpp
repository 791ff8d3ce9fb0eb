#pragma once

#include <fastdds/dds/domain/qos/DomainParticipantQos.hpp>
#include <string>

#include "furrow_dds/dds_parameters.hpp"

namespace furrow::dds {

/// Throws ConfigError on parameters out of range and malformed addresses.
[[nodiscard]] eprosima::fastdds::dds::DomainParticipantQos participant_qos(
    const DdsParameters& parameters);

/// What a participant of ours tells of its process, as user data "key=value;".
[[nodiscard]] std::string process_user_data();
/// The value behind `key`, or empty.
[[nodiscard]] std::string user_data_value(const std::string& user_data, const std::string& key);

}  // namespace furrow::dds
