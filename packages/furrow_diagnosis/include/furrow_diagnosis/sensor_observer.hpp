#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "furrow_components/georeference.hpp"
#include "furrow_diagnosis/observation.hpp"
#include "furrow_diagnosis/sensor_expectation.hpp"
#include "furrow_msgs/nav_msgs.h"
#include "furrow_msgs/sensor_msgs.h"

namespace furrow::diagnosis {

/// Turns messages into observations. Keeps numbers, no images. Not thread-safe.
class SensorObserver {
 public:
  /// Messages of one topic that are kept at most; later ones are only counted.
  static constexpr std::size_t kMaxSamples = 20'000;

  /// Throws ConfigError for a bad georeference.
  explicit SensorObserver(const SensorSetup& setup);

  /// A message of setup.inputs[input], in CDR form with its header. Any bytes are allowed.
  void take(std::size_t input, std::span<const std::byte> payload, Time sent, Time arrival);

  /// What was seen so far, without the writers, of which messages say nothing.
  [[nodiscard]] const Observations& observations() const { return seen_; }

 private:
  void image(TopicObservation& topic, std::span<const std::byte> payload, MessageTimes times);
  void camera_info(TopicObservation& topic, std::span<const std::byte> payload, MessageTimes times);
  void depth(TopicObservation& topic, std::span<const std::byte> payload, MessageTimes times);
  void wheels(TopicObservation& topic, std::span<const std::byte> payload, MessageTimes times);
  void imu(TopicObservation& topic, std::span<const std::byte> payload, MessageTimes times);
  void gnss(TopicObservation& topic, std::span<const std::byte> payload, MessageTimes times);

  double depth_unit_m_;
  bool rectified_;
  components::Georeference georeference_;
  Observations seen_;
};

}  // namespace furrow::diagnosis
