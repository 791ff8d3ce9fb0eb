#pragma once

#include <cstdint>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_graph/health.hpp"

namespace furrow::launch {

/// What went wrong on the wire of a process, from one look to the next: a warning while there are
/// new misses, with the topics; counters over the whole run.
class TransportHealth {
 public:
  explicit TransportHealth(const dds::DdsTransport& transport) : transport_(transport) {}
  [[nodiscard]] graph::Health look();

 private:
  const dds::DdsTransport& transport_;
  std::uint64_t misses_ = 0;
};

}  // namespace furrow::launch
