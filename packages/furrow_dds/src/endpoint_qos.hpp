#pragma once

#include <fastdds/dds/publisher/qos/DataWriterQos.hpp>
#include <fastdds/dds/subscriber/qos/DataReaderQos.hpp>

#include "furrow_msgs/qos.hpp"

namespace furrow::dds {

[[nodiscard]] eprosima::fastrtps::Duration_t to_dds(Duration duration);
/// Zero if the duration is infinite.
[[nodiscard]] Duration from_dds(const eprosima::fastrtps::Duration_t& duration);

[[nodiscard]] eprosima::fastdds::dds::DataWriterQos writer_qos(const msgs::Qos& qos);
[[nodiscard]] eprosima::fastdds::dds::DataReaderQos reader_qos(const msgs::Qos& qos);

}  // namespace furrow::dds
