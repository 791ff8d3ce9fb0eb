#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_graph/health.hpp"
#include "furrow_launch/external_inputs.hpp"

namespace furrow::launch {

/// The faults of a process's transport, with their topics. A warning tells faults since the last
/// look, and external inputs that are not heard. Counters are over the whole run.
class TransportHealth {
 public:
  TransportHealth(const dds::DdsTransport& transport, std::vector<ExternalInput> inputs)
      : transport_(transport), inputs_(std::move(inputs)) {}
  [[nodiscard]] graph::Health look();

 private:
  const dds::DdsTransport& transport_;
  InputWatch inputs_;
  std::uint64_t misses_ = 0;
};

}  // namespace furrow::launch
