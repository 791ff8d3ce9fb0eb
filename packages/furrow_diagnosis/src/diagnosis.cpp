#include "furrow_diagnosis/diagnosis.hpp"

#include <algorithm>
#include <iterator>

#include "turn_comparison.hpp"

namespace furrow::diagnosis {
namespace {

void append(Findings& all, Findings more) {
  all.insert(all.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

std::vector<std::string> not_checked(const Observations& seen) {
  std::vector<std::string> notes;
  if (!seen.imu.empty() && !seen.wheels.empty() && !turn_of(seen.imu, seen.wheels).turned) {
    notes.emplace_back(
        "unit and sign of the turn of IMU and wheels: the robot did not turn; turn it on the spot "
        "or drive a curve");
  }
  if (!seen.wheels.empty() && path_length_m(seen.wheels) < kShortestPath_m) {
    notes.emplace_back("unit and sign of the wheels' speed: the robot did not drive");
  }
  const bool covariance = std::ranges::any_of(seen.gnss, &GnssSample::covariance_known);
  if (!seen.gnss.empty() && !covariance) {
    notes.emplace_back("accuracy of the fixes: the driver publishes no covariance");
  }
  if (seen.image && seen.depth && !seen.depth->median_m && seen.depth->problem.empty()) {
    notes.emplace_back("unit of the depth: no pixel has a depth");
  }
  return notes;
}

}  // namespace

std::string to_string(Rank rank) {
  switch (rank) {
    case Rank::kDelivery:
      return "delivery";
    case Rank::kClock:
      return "clock";
    case Rank::kFormat:
      return "format";
    case Rank::kValue:
      return "value";
    case Rank::kFrame:
      return "frame";
    case Rank::kRate:
      break;
  }
  return "rate";
}

const TopicObservation* Observations::find(Role role) const {
  const auto it = std::ranges::find(topics, role, &TopicObservation::role);
  return it == topics.end() ? nullptr : &*it;
}

Diagnosis diagnose(const Observations& seen, const Expectation& expected) {
  std::vector<const TopicObservation*> topics;
  for (const TopicObservation& topic : seen.topics) topics.push_back(&topic);
  std::ranges::stable_sort(topics, {}, &TopicObservation::role);
  Diagnosis diagnosis;
  for (const TopicObservation* topic : topics) {
    append(diagnosis.findings, check_delivery(*topic));
    append(diagnosis.findings, check_stamps(*topic));
    append(diagnosis.findings, check_rate(*topic, seen.seconds));
  }
  append(diagnosis.findings, check_camera(seen, expected));
  append(diagnosis.findings, check_depth(seen, expected));
  append(diagnosis.findings, check_wheels(seen, expected));
  append(diagnosis.findings, check_imu(seen));
  append(diagnosis.findings, check_gnss(seen, expected));
  std::ranges::stable_sort(diagnosis.findings, {}, &Finding::rank);
  diagnosis.not_checked = not_checked(seen);
  const bool unheard = std::ranges::find(diagnosis.findings, "topic.no_writer", &Finding::check) !=
                       diagnosis.findings.end();
  if (unheard && seen.only_this_host) {
    diagnosis.not_checked.emplace_back(
        "drivers on other hosts: only 127.0.0.1 was used; give --dds interfaces=ADDRESS");
  }
  return diagnosis;
}

}  // namespace furrow::diagnosis
