#pragma once

#include <cstdint>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_graph/health.hpp"

namespace furrow::launch {

/// The faults of a process's transport: a warning, with the topics, while there are faults since
/// the last look; counters over the whole run.
class TransportHealth {
 public:
  explicit TransportHealth(const dds::DdsTransport& transport) : transport_(transport) {}
  [[nodiscard]] graph::Health look();

 private:
  const dds::DdsTransport& transport_;
  std::uint64_t misses_ = 0;
};

}  // namespace furrow::launch
