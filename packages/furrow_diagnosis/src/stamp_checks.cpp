#include <algorithm>
#include <cmath>
#include <ctime>

#include "furrow_core/statistics.hpp"
#include "furrow_core/text.hpp"
#include "furrow_diagnosis/diagnosis.hpp"

namespace furrow::diagnosis {
namespace {

constexpr double kAhead_s = 0.005;     // a clock that PTP or chrony holds is better
constexpr double kHostBehind_s = 0.2;  // no network of a robot delays each message so long
constexpr double kOtherClock_s = 3600.0;

/// The longest delay of the driver before each message.
double longest_delay_s(Role role) {
  return role == Role::kWheels || role == Role::kImu ? 0.2 : 0.5;
}

std::string year_of(Time time) {
  const std::time_t seconds = time.count_ns() / 1'000'000'000;
  std::tm utc{};
  if (gmtime_r(&seconds, &utc) == nullptr) return "no year";
  return std::to_string(1900 + utc.tm_year);
}

/// Without the offset of the hosts' clocks where the writer's time is known.
Time reference(const MessageTimes& times) {
  return times.sent == Time() ? times.arrival : times.sent;
}

struct Offsets {
  double host_s = 0.0;    ///< least arrival less sent; 0: unknown
  double driver_s = 0.0;  ///< least sent less stamp
};

/// The least delay has the least of network and queues.
Offsets offsets_of(const std::vector<MessageTimes>& all) {
  std::vector<double> hosts_s;
  std::vector<double> drivers_s;
  for (const MessageTimes& times : all) {
    hosts_s.push_back((times.arrival - reference(times)).to_seconds());
    drivers_s.push_back((reference(times) - times.stamp).to_seconds());
  }
  return {*std::ranges::min_element(hosts_s), *std::ranges::min_element(drivers_s)};
}

}  // namespace

Findings check_stamps(const TopicObservation& topic) {
  if (topic.times.empty()) return {};
  Findings findings;
  const auto add = [&](const char* check, std::string problem, std::string remedy) {
    findings.push_back({Rank::kClock, topic.topic, check, std::move(problem), std::move(remedy)});
  };
  const auto count = topic.times.size();
  const auto zero = static_cast<std::size_t>(std::ranges::count_if(
      topic.times, [](const MessageTimes& times) { return times.stamp == Time(); }));
  if (zero > 0) {
    add("stamp.zero", std::to_string(zero) + " of " + std::to_string(count) + " stamps are zero",
        "set header.stamp to the time of the measurement");
    return findings;
  }
  const Offsets offsets = offsets_of(topic.times);
  if (std::abs(offsets.driver_s) > kOtherClock_s) {
    add("stamp.other_clock",
        "the stamps are of another clock: " + year_of(topic.times.back().stamp) + ", " +
            fixed(offsets.driver_s, 0) + " s before they are sent",
        "stamp with the system clock (use_sim_time false, no clock since boot)");
    return findings;
  }
  if (offsets.host_s < -kAhead_s || offsets.host_s > kHostBehind_s) {
    const bool ahead = offsets.host_s < 0.0;
    add("stamp.host_clock",
        "the clock of the writer's host is " + fixed(std::abs(offsets.host_s), 3) + " s " +
            (ahead ? "ahead of" : "behind") + " this host's",
        "synchronize the clocks of the hosts (chrony, PTP)");
  }
  if (offsets.driver_s < -kAhead_s) {
    add("stamp.future",
        "the stamps are " + fixed(-offsets.driver_s, 3) + " s ahead of the time they are sent",
        "synchronize the sensor's clock with its host (PTP), or stamp with the host's clock");
  } else if (offsets.driver_s > longest_delay_s(topic.role)) {
    add("stamp.late",
        "every stamp is at least " + fixed(offsets.driver_s, 3) +
            " s older than the time it is sent",
        "synchronize the sensor's clock with its host, or shorten the driver's queue");
  }
  std::size_t backwards = 0;
  for (std::size_t i = 1; i < count; ++i) {
    if (topic.times[i].stamp <= topic.times[i - 1].stamp) ++backwards;
  }
  if (backwards > 0 && topic.writers.size() < 2) {
    add("stamp.order",
        std::to_string(backwards) + " of " + std::to_string(count) +
            " stamps are not later than the one before",
        "stamp each message with the time of its own measurement");
  }
  return findings;
}

}  // namespace furrow::diagnosis
