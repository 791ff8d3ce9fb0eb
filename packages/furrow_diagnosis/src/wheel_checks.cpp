#include <algorithm>
#include <cmath>
#include <optional>

#include "furrow_core/text.hpp"
#include "furrow_diagnosis/diagnosis.hpp"
#include "turn_comparison.hpp"

namespace furrow::diagnosis {
namespace {

bool finite_wheels(const WheelSample& sample) {
  return sample.position_m.allFinite() && std::isfinite(sample.yaw_rad) &&
         std::isfinite(sample.speed_mps) && std::isfinite(sample.yaw_rate_radps);
}

/// The way along the robot's x axis by the poses, and by the twist over the stamps.
struct Way {
  double poses_m = 0.0;
  double twist_m = 0.0;
  double length_m = 0.0;  ///< of the poses, in any direction
};

Way way_of(const std::vector<WheelSample>& wheels) {
  Way way;
  for (std::size_t i = 1; i < wheels.size(); ++i) {
    const WheelSample& a = wheels[i - 1];
    const WheelSample& b = wheels[i];
    const Eigen::Vector2d step_m = b.position_m - a.position_m;
    way.poses_m += step_m.dot(Eigen::Vector2d(std::cos(a.yaw_rad), std::sin(a.yaw_rad)));
    way.length_m += step_m.norm();
    way.twist_m += 0.5 * (a.speed_mps + b.speed_mps) * (b.stamp - a.stamp).to_seconds();
  }
  return way;
}

/// Lengths of the way while fixes came: of the fixes, and of the speed of the wheels.
struct WayByGnss {
  double gnss_m = 0.0;
  double wheels_m = 0.0;
};

/// Empty: the fixes are not accurate enough to compare.
std::optional<WayByGnss> way_by_gnss(const Observations& seen) {
  constexpr double kAccurate_m2 = 0.05 * 0.05;
  const bool accurate = std::ranges::all_of(seen.gnss, [](const GnssSample& fix) {
    const Eigen::Vector2d variances_m2 = fix.covariance_m2.diagonal();
    return fix.status >= 0 && fix.covariance_known && fix.p_FA_m.allFinite() &&
           variances_m2.minCoeff() > 0.0 && variances_m2.maxCoeff() <= kAccurate_m2;
  });
  if (!accurate || seen.gnss.size() < 2) return std::nullopt;
  WayByGnss way;
  for (std::size_t i = 1; i < seen.gnss.size(); ++i) {
    way.gnss_m += (seen.gnss[i].p_FA_m - seen.gnss[i - 1].p_FA_m).norm();
  }
  for (std::size_t i = 1; i < seen.wheels.size(); ++i) {
    const WheelSample& a = seen.wheels[i - 1];
    const WheelSample& b = seen.wheels[i];
    if (a.arrival < seen.gnss.front().arrival || b.arrival > seen.gnss.back().arrival) continue;
    way.wheels_m += std::abs(a.speed_mps) * (b.arrival - a.arrival).to_seconds();
  }
  return way;
}

/// The unit that is `ratio` times as small as m/s; empty: none.
std::string speed_unit(double ratio) {
  if (near_ratio(ratio, 3.6)) return "km/h";
  if (near_ratio(ratio, 100.0)) return "cm/s";
  if (near_ratio(ratio, 1000.0)) return "mm/s";
  return "";
}

class WheelCheck {
 public:
  WheelCheck(const Observations& seen, const Expectation& expected, const TopicObservation& topic)
      : seen_(seen), expected_(expected), topic_(topic) {}

  Findings run() {
    const auto bad = seen_.wheels.size() -
                     static_cast<std::size_t>(std::ranges::count_if(seen_.wheels, finite_wheels));
    if (bad > 0) {
      add(Rank::kFormat, "wheels.not_finite",
          std::to_string(bad) + " of " + std::to_string(seen_.wheels.size()) +
              " messages hold NaN or infinity",
          "let the driver drop measurements that failed");
      return std::move(findings_);
    }
    check_position();
    const std::size_t before = findings_.size();
    check_speed();
    if (findings_.size() == before) check_speed_by_gnss();
    if (findings_.size() == before) check_fastest();
    check_yaw_rate();
    check_frame();
    return std::move(findings_);
  }

 private:
  void add(Rank rank, const char* check, std::string problem, std::string remedy) {
    findings_.push_back({rank, topic_.topic, check, std::move(problem), std::move(remedy)});
  }

  void check_position() {
    const Eigen::Vector2d& p = seen_.wheels.front().position_m;
    if (p.cwiseAbs().maxCoeff() <= expected_.max_field_m) return;
    add(Rank::kValue, "wheels.coordinates",
        "the position is (" + fixed(p.x(), 0) + ", " + fixed(p.y(), 0) +
            ") m, as of a map or UTM; at most " + fixed(expected_.max_field_m, 0) +
            " m are a field",
        "start the odometry at zero, or set localization.start=parameters");
  }

  /// Needs stamps that can be used.
  void check_speed() {
    const Way way = way_of(seen_.wheels);
    const bool compared = way.length_m > kShortestPath_m && check_stamps(topic_).empty();
    if (compared && std::abs(way.twist_m) < 0.02 * way.length_m) {
      add(Rank::kValue, "wheels.no_twist",
          "the pose moved " + fixed(way.length_m, 2) + " m, but the twist is zero",
          "let the driver fill in twist.linear.x and twist.angular.z, which Furrow uses");
      return;
    }
    const double ratio = compared && way.poses_m != 0.0 ? way.twist_m / way.poses_m : 1.0;
    const std::string compared_text =
        "the twist says " + fixed(way.twist_m, 2) + " m, the poses " + fixed(way.poses_m, 2) + " m";
    if (const std::string unit = speed_unit(std::abs(ratio)); !unit.empty()) {
      add(Rank::kValue, "wheels.speed_unit", compared_text + ": the speed is in " + unit,
          "publish m/s");
    } else if (ratio < 0.0) {
      add(Rank::kValue, "wheels.speed_sign", compared_text,
          "positive is forward for both, along x of the base frame (REP 103)");
    } else if (!near_ratio(ratio, 1.0)) {
      add(Rank::kValue, "wheels.speed_scale", compared_text,
          "check the wheel radius and the unit of twist.linear.x");
    }
  }

  /// Where poses and twist agree, both may have the wrong unit.
  void check_speed_by_gnss() {
    constexpr double kLongEnough_m = 1.5;  // beside noise, and a turning antenna
    const auto way = way_by_gnss(seen_);
    if (!way || std::max(way->gnss_m, way->wheels_m) < kLongEnough_m) return;
    const double ratio = way->wheels_m / way->gnss_m;
    if (near_ratio(ratio, 1.0)) return;
    const std::string unit = speed_unit(ratio);
    add(Rank::kValue, unit.empty() ? "wheels.against_gnss" : "wheels.speed_unit",
        "the wheels say " + fixed(way->wheels_m, 2) + " m, the GNSS " + fixed(way->gnss_m, 2) +
            " m" + (unit.empty() ? "" : ": the speed is in " + unit),
        unit.empty() ? "check unit and wheel radius, and that the fixes are not repeated"
                     : "publish m/s");
  }

  void check_fastest() {
    constexpr double kFastest_mps = 5.0;
    const WheelSample& fastest = *std::ranges::max_element(
        seen_.wheels, {}, [](const WheelSample& sample) { return std::abs(sample.speed_mps); });
    if (std::abs(fastest.speed_mps) <= kFastest_mps) return;
    add(Rank::kValue, "wheels.speed_unit",
        "the speed reaches " + fixed(fastest.speed_mps, 1) + " m/s, which no weeding robot drives",
        "publish m/s, not km/h or mm/s");
  }

  void check_yaw_rate() {
    const Turn turn = turn_of(seen_.imu, seen_.wheels);
    if (turn.turned && near_ratio(std::abs(turn.gain), 1.0 / kDegPerRad)) {
      add(Rank::kValue, "wheels.yaw_rate_unit",
          "the wheels turn " + fixed(1.0 / std::abs(turn.gain), 0) +
              " times as fast as the IMU: they publish deg/s",
          "publish rad/s");
    }
  }

  void check_frame() {
    const std::string& child = seen_.wheels_child_frame;
    if (child == expected_.base_link || child == "base_footprint") return;
    add(Rank::kFrame, "wheels.child_frame",
        "child_frame_id is '" + child + "', the base of the URDF '" + expected_.base_link + "'",
        "publish the odometry of the base link");
  }

  const Observations& seen_;
  const Expectation& expected_;
  const TopicObservation& topic_;
  Findings findings_;
};

}  // namespace

double path_length_m(const std::vector<WheelSample>& wheels) {
  return way_of(wheels).length_m;
}

Findings check_wheels(const Observations& seen, const Expectation& expected) {
  const TopicObservation* topic = seen.find(Role::kWheels);
  if (topic == nullptr || seen.wheels.empty()) return {};
  return WheelCheck(seen, expected, *topic).run();
}

}  // namespace furrow::diagnosis
