#include "endpoint_qos.hpp"

#include <algorithm>

namespace furrow::dds {

namespace fdds = eprosima::fastdds::dds;
using eprosima::fastrtps::Duration_t;

namespace {

constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
// A lost fragment is requested and sent again within a few of these periods. Fast DDS's default of
// 3 s between heartbeats would stall a topic for seconds.
constexpr Duration kHeartbeatPeriod = Duration::milliseconds(20);
constexpr Duration kNackResponseDelay = Duration::milliseconds(1);
constexpr Duration kHeartbeatResponseDelay = Duration::milliseconds(1);
constexpr Duration kInitialAcknackDelay = Duration::milliseconds(20);
constexpr Duration kMaxBlocking = Duration::milliseconds(100);
constexpr int kPreallocatedSamples = 2;

template <class EndpointQos>
void set_common(const msgs::Qos& qos, EndpointQos& out) {
  const int depth = std::max(1, qos.depth);
  out.reliability().kind = qos.reliability == msgs::Reliability::kReliable
                               ? fdds::RELIABLE_RELIABILITY_QOS
                               : fdds::BEST_EFFORT_RELIABILITY_QOS;
  out.reliability().max_blocking_time = to_dds(kMaxBlocking);
  out.durability().kind = qos.durability == msgs::Durability::kTransientLocal
                              ? fdds::TRANSIENT_LOCAL_DURABILITY_QOS
                              : fdds::VOLATILE_DURABILITY_QOS;
  out.history().kind = fdds::KEEP_LAST_HISTORY_QOS;
  out.history().depth = depth;
  out.resource_limits().max_samples = depth;
  out.resource_limits().max_instances = 1;
  out.resource_limits().max_samples_per_instance = depth;
  out.resource_limits().allocated_samples = std::min(depth, kPreallocatedSamples);
  if (qos.deadline > Duration()) {
    out.deadline().period = to_dds(qos.deadline);
  }
  out.liveliness().kind = fdds::AUTOMATIC_LIVELINESS_QOS;
  if (qos.liveliness_lease > Duration()) {
    out.liveliness().lease_duration = to_dds(qos.liveliness_lease);
    out.liveliness().announcement_period =
        to_dds(Duration::nanoseconds(qos.liveliness_lease.count_ns() / 3));
  }
  // Fast DDS recycles slots of shared histories while they are read.
  out.data_sharing().off();
  out.endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
}

}  // namespace

Duration_t to_dds(Duration duration) {
  const std::int64_t ns = duration.count_ns();
  return Duration_t(static_cast<std::int32_t>(ns / kNanosecondsPerSecond),
                    static_cast<std::uint32_t>(ns % kNanosecondsPerSecond));
}

Duration from_dds(const Duration_t& duration) {
  if (duration == eprosima::fastrtps::c_TimeInfinite) {
    return {};
  }
  return Duration::nanoseconds(duration.to_ns());
}

fdds::DataWriterQos writer_qos(const msgs::Qos& qos) {
  fdds::DataWriterQos out = fdds::DATAWRITER_QOS_DEFAULT;
  set_common(qos, out);
  if (qos.lifespan > Duration()) out.lifespan().duration = to_dds(qos.lifespan);
  // Our own threads send, so that large and small messages do not share a thread.
  out.publish_mode().kind = fdds::SYNCHRONOUS_PUBLISH_MODE;
  auto& times = out.reliable_writer_qos().times;
  times.initialHeartbeatDelay = to_dds(kNackResponseDelay);
  times.heartbeatPeriod = to_dds(kHeartbeatPeriod);
  times.nackResponseDelay = to_dds(kNackResponseDelay);
  return out;
}

fdds::DataReaderQos reader_qos(const msgs::Qos& qos) {
  fdds::DataReaderQos out = fdds::DATAREADER_QOS_DEFAULT;
  set_common(qos, out);
  auto& times = out.reliable_reader_qos().times;
  times.initialAcknackDelay = to_dds(kInitialAcknackDelay);
  times.heartbeatResponseDelay = to_dds(kHeartbeatResponseDelay);
  return out;
}

}  // namespace furrow::dds
