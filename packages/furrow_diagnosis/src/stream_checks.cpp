#include <algorithm>
#include <cmath>
#include <numeric>

#include "furrow_core/statistics.hpp"
#include "furrow_core/text.hpp"
#include "furrow_diagnosis/diagnosis.hpp"

namespace furrow::diagnosis {
namespace {

std::string effect_of(const TopicObservation& topic) {
  return topic.readers +
         (topic.required ? " cannot work without it" : " works without it, with less accuracy");
}

Finding no_writer(const TopicObservation& topic) {
  Finding finding{Rank::kDelivery, topic.topic, "topic.no_writer",
                  "no writer was found; " + effect_of(topic),
                  "start the driver, with the same ROS_DOMAIN_ID"};
  for (const std::string& other : topic.alternatives) {
    finding.remedy += other.starts_with("//")
                          ? "; '" + other.substr(2) + "' has no prefix rt/, which ROS 2 topics have"
                          : "; or remap it to '" + other + "', which has this type";
  }
  return finding;
}

std::vector<double> periods_s(const std::vector<MessageTimes>& times, Time MessageTimes::*member) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < times.size(); ++i) {
    periods.push_back((times[i].*member - times[i - 1].*member).to_seconds());
  }
  return periods;
}

/// The lowest rates with which Furrow works well. Images overlap at 1 m/s; the drivers' watchdogs
/// see 10 poses a second; the filter follows the heading.
double lowest_rate_hz(Role role) {
  switch (role) {
    case Role::kImage:
    case Role::kDepth:
      return 1.0;
    case Role::kWheels:
      return 10.0;
    case Role::kImu:
      return 20.0;
    case Role::kGnss:
      return 0.5;
    case Role::kCameraInfo:  // one is enough
    case Role::kOther:
      break;
  }
  return 0.0;
}

/// Missing messages by the gaps between stamps, as a part of all; empty: the stamps are irregular.
std::optional<double> missing_part(const TopicObservation& topic) {
  constexpr std::size_t kEnough = 10;
  const auto periods = periods_s(topic.times, &MessageTimes::stamp);
  if (periods.size() < kEnough) return std::nullopt;
  const double usual_s = median(periods);
  if (usual_s <= 0.0) return std::nullopt;
  const auto regular = std::ranges::count_if(
      periods, [&](double period_s) { return std::abs(period_s - usual_s) < 0.2 * usual_s; });
  constexpr double kRegular = 0.6;
  const auto count = static_cast<double>(periods.size());
  if (static_cast<double>(regular) < kRegular * count) return std::nullopt;
  const double span_s = std::accumulate(periods.begin(), periods.end(), 0.0);
  return std::max(0.0, 1.0 - count * usual_s / span_s);
}

}  // namespace

StreamFigures figures_of(const TopicObservation& topic) {
  StreamFigures figures;
  const auto periods = periods_s(topic.times, &MessageTimes::arrival);
  const double span_s = std::accumulate(periods.begin(), periods.end(), 0.0);
  if (span_s > 0.0) {
    const auto count = static_cast<double>(periods.size());
    const double mean_s = span_s / count;
    double squares = 0.0;
    for (const double period_s : periods) squares += (period_s - mean_s) * (period_s - mean_s);
    figures.rate_hz = 1.0 / mean_s;
    figures.jitter_s = std::sqrt(squares / count);
  }
  std::vector<double> delays_s;
  for (const MessageTimes& times : topic.times) {
    if (times.stamp != Time()) delays_s.push_back((times.arrival - times.stamp).to_seconds());
  }
  if (!delays_s.empty()) figures.delay_s = median(std::move(delays_s));
  return figures;
}

Findings check_delivery(const TopicObservation& topic) {
  Findings findings;
  const auto add = [&](const char* check, std::string problem, std::string remedy) {
    findings.push_back(
        {Rank::kDelivery, topic.topic, check, std::move(problem), std::move(remedy)});
  };
  if (topic.writers.empty() && topic.messages == 0) return {no_writer(topic)};
  std::vector<std::string> matching;
  for (const ObservedWriter& writer : topic.writers) {
    if (writer.type != topic.type) {
      add("topic.type",
          "process '" + writer.process + "' writes " + writer.type + " instead of " + topic.type,
          "use a driver that writes " + topic.type + ", or give that topic another name");
    } else if (!writer.incompatibility.empty()) {
      add("topic.qos",
          "the QoS of process '" + writer.process + "' does not match; " + writer.incompatibility,
          "offer at least the requested QoS in the driver");
    } else {
      matching.push_back(writer.process);
    }
  }
  if (matching.size() > 1) {
    std::string names;
    for (const std::string& name : matching) names += (names.empty() ? "'" : ", '") + name + "'";
    add("topic.two_writers", std::to_string(matching.size()) + " writers publish it: " + names,
        "stop all but one, or give them topics of their own");
  }
  if (!matching.empty() && topic.messages == 0) {
    add("topic.silent", "process '" + matching.front() + "' has a writer, but no message arrived",
        "check that the sensor delivers, the firewall, and the size of the receive buffer");
  }
  if (topic.malformed > 0) {
    add("topic.malformed",
        std::to_string(topic.malformed) + " of " + std::to_string(topic.messages) +
            " messages are no " + topic.type,
        "build the driver with the message definitions of ROS 2");
  }
  return findings;
}

Findings check_rate(const TopicObservation& topic, double seconds) {
  const double lowest_hz = lowest_rate_hz(topic.role);
  if (lowest_hz == 0.0 || topic.messages == 0 || topic.times.empty()) return {};
  Findings findings;
  const auto add = [&](const char* check, std::string problem, std::string remedy) {
    findings.push_back({Rank::kRate, topic.topic, check, std::move(problem), std::move(remedy)});
  };
  const StreamFigures figures = figures_of(topic);
  // One message in a short time says nothing.
  constexpr double kExpected = 2.0;
  const bool enough = figures.rate_hz || seconds * lowest_hz >= kExpected;
  const double rate_hz =
      figures.rate_hz.value_or(static_cast<double>(topic.times.size()) / seconds);
  if (enough && rate_hz < lowest_hz) {
    add("rate.low", fixed(rate_hz, 2) + " Hz; at least " + fixed(lowest_hz, 1) + " Hz are needed",
        "raise the rate of the driver");
  }
  constexpr double kMissing = 0.05;
  if (const auto missing = missing_part(topic); missing && *missing > kMissing) {
    add("rate.lost", fixed(100.0 * *missing, 0) + " % of the messages are missing by their stamps",
        "use a reliable writer, raise net.core.rmem_max, or send less");
  }
  constexpr double kLongestGap_s = 0.1;  // of localization/odometry, which follows the wheels
  const auto periods = periods_s(topic.times, &MessageTimes::arrival);
  if (topic.role == Role::kWheels && rate_hz >= lowest_hz) {
    constexpr double kTail = 0.95;
    if (const double gap_s = quantile(periods, kTail); gap_s > kLongestGap_s) {
      add("rate.bursts", "5 % of the gaps are longer than " + fixed(1e3 * gap_s, 0) + " ms",
          "send each message when it is measured");
    }
  }
  return findings;
}

}  // namespace furrow::diagnosis
