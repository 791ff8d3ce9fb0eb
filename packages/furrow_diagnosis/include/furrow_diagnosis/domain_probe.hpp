#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_diagnosis/sensor_observer.hpp"

namespace furrow::diagnosis {

/// Fills in writers and alternatives of an input from the domain. `inputs` are all inputs of the
/// graph, which are no alternatives.
void add_writers(TopicObservation& topic, const launch::ExternalInput& input,
                 const std::vector<SensorInput>& inputs, const dds::DiscoverySnapshot& domain);

/// Subscribes to all inputs of a graph, as its components do, and observes them.
class DomainProbe {
 public:
  /// Throws ConfigError. `transport` must outlive the probe.
  DomainProbe(dds::DdsTransport& transport, const SensorSetup& setup);

  /// What was seen since the construction, `seconds` ago. From any thread.
  [[nodiscard]] Observations observations(double seconds) const;

 private:
  const dds::DdsTransport& transport_;
  std::vector<SensorInput> inputs_;
  mutable std::mutex mutex_;
  SensorObserver observer_;
  std::vector<std::unique_ptr<dds::RawReader>> readers_;  // last: they call the observer
};

}  // namespace furrow::diagnosis
