#pragma once

#include <optional>
#include <string>
#include <vector>

#include "furrow_diagnosis/finding.hpp"
#include "furrow_diagnosis/observation.hpp"

namespace furrow::diagnosis {

/// Delay of a topic's messages, and how regularly they come. Empty of fewer than two messages.
struct StreamFigures {
  std::optional<double> rate_hz;
  std::optional<double> jitter_s;  ///< standard deviation of the time between arrivals
  std::optional<double> delay_s;   ///< median of arrival less stamp; empty: no stamp
};
[[nodiscard]] StreamFigures figures_of(const TopicObservation& topic);

// Each function checks one kind of input. Nothing is found where there is nothing to check.

/// Writers, types, QoS, delivery.
[[nodiscard]] Findings check_delivery(const TopicObservation& topic);
/// Stamps against the clocks of writer and reader.
[[nodiscard]] Findings check_stamps(const TopicObservation& topic);
/// Rate, losses and bursts.
[[nodiscard]] Findings check_rate(const TopicObservation& topic, double seconds);
/// Colour image and calibration.
[[nodiscard]] Findings check_camera(const Observations& seen, const Expectation& expected);
[[nodiscard]] Findings check_depth(const Observations& seen, const Expectation& expected);
[[nodiscard]] Findings check_imu(const Observations& seen);
[[nodiscard]] Findings check_wheels(const Observations& seen, const Expectation& expected);
[[nodiscard]] Findings check_gnss(const Observations& seen, const Expectation& expected);

struct Diagnosis {
  Findings findings;                     ///< the most fundamental first
  std::vector<std::string> not_checked;  ///< what the data did not show, and how to show it
};
[[nodiscard]] Diagnosis diagnose(const Observations& seen, const Expectation& expected);

}  // namespace furrow::diagnosis
