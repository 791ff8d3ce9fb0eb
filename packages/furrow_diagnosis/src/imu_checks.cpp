#include <algorithm>
#include <cmath>

#include "furrow_core/text.hpp"
#include "furrow_diagnosis/diagnosis.hpp"
#include "turn_comparison.hpp"

namespace furrow::diagnosis {
namespace {

constexpr double kFastestTurn_radps = 6.0;

class ImuCheck {
 public:
  ImuCheck(const Observations& seen, const TopicObservation& topic) : seen_(seen), topic_(topic) {}

  Findings run() {
    const auto count = seen_.imu.size();
    const auto bad =
        static_cast<std::size_t>(std::ranges::count_if(seen_.imu, [](const ImuSample& sample) {
          return !sample.rate_radps.allFinite() || !sample.acceleration_mps2.allFinite();
        }));
    if (bad > 0) {
      add(Rank::kFormat, "imu.not_finite",
          std::to_string(bad) + " of " + std::to_string(count) + " messages hold NaN or infinity",
          "let the driver drop measurements that failed");
      return std::move(findings_);
    }
    if (std::ranges::any_of(seen_.imu, &ImuSample::rate_unknown)) {
      add(Rank::kFormat, "imu.no_rate", "angular_velocity_covariance[0] is -1: no rate is measured",
          "publish the topic of the IMU that has angular rates");
      return std::move(findings_);
    }
    check_turn();
    check_gravity();
    if (topic_.frame.empty()) {
      add(Rank::kFrame, "imu.frame", "frame_id is empty", "set frame_id to a link of the URDF");
    }
    return std::move(findings_);
  }

 private:
  void add(Rank rank, const char* check, std::string problem, std::string remedy) {
    findings_.push_back({rank, topic_.topic, check, std::move(problem), std::move(remedy)});
  }

  void check_turn() {
    double fastest_radps = 0.0;
    for (const ImuSample& sample : seen_.imu) {
      fastest_radps = std::max(fastest_radps, std::abs(sample.rate_radps.z()));
    }
    const Turn turn = turn_of(seen_.imu, seen_.wheels);
    const std::string gain =
        "the IMU turns " + fixed(turn.gain, 2) + " times as fast as the wheels";
    constexpr double kFollows = 0.7;
    if (!turn.turned) {
      if (fastest_radps > kFastestTurn_radps) {
        add(Rank::kValue, "imu.rate_unit",
            "angular_velocity.z reaches " + fixed(fastest_radps, 1) +
                " rad/s, which no field robot does",
            "publish rad/s; deg/s are 57 times as large");
      }
      return;
    }
    if (std::abs(turn.correlation) < kFollows) {
      add(Rank::kValue, "imu.axis", "angular_velocity.z does not follow the turn of the wheels",
          "mount the IMU, or rotate its data, so that z points up");
      return;
    }
    if (near_ratio(std::abs(turn.gain), kDegPerRad)) {
      add(Rank::kValue, "imu.rate_unit", gain + ": it publishes deg/s", "publish rad/s");
    } else if (near_ratio(std::abs(turn.gain), 1.0 / kDegPerRad)) {
      return;  // The wheels publish deg/s.
    } else if (!near_ratio(std::abs(turn.gain), 1.0)) {
      add(Rank::kValue, "imu.rate_scale", gain,
          "check the scale of the gyroscope, and track width and wheel radius of the odometry");
    }
    if (turn.gain < 0.0) {
      add(Rank::kValue, "imu.turn_sign", "the IMU turns against the wheels",
          "counter-clockwise is positive for both (REP 103): rotate the IMU's data so that z "
          "points up");
    }
  }

  void check_gravity() {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const ImuSample& sample : seen_.imu) mean += sample.acceleration_mps2;
    mean /= static_cast<double>(seen_.imu.size());
    const double norm = mean.norm();
    constexpr double kNone = 0.1;  // no accelerometer, or gravity is taken out
    constexpr double kGravity_mps2 = 9.81;
    constexpr double kUpright = 0.9;
    if (norm < kNone) return;
    const std::string vector =
        "(" + fixed(mean.x(), 2) + ", " + fixed(mean.y(), 2) + ", " + fixed(mean.z(), 2) + ")";
    if (mean.z() < kUpright * norm) {
      add(Rank::kValue, "imu.gravity_axis",
          "the mean acceleration is " + vector + " m/s2; z does not point up",
          "a robot that stands has +9.81 along z: turn the IMU, or rotate its data in the driver");
    } else if (near_ratio(norm, 1.0)) {
      add(Rank::kValue, "imu.acceleration_unit",
          "the mean acceleration is " + vector + ", which is in g", "publish m/s2");
    } else if (!near_ratio(norm, kGravity_mps2)) {
      add(Rank::kValue, "imu.acceleration_scale",
          "the mean acceleration is " + vector + " m/s2 instead of 9.81", "publish m/s2");
    }
  }

  const Observations& seen_;
  const TopicObservation& topic_;
  Findings findings_;
};

}  // namespace

bool near_ratio(double ratio, double wanted) {
  return std::abs(ratio / wanted - 1.0) <= kLargestScaleError;
}

Turn turn_of(const std::vector<ImuSample>& imu, const std::vector<WheelSample>& wheels) {
  constexpr Duration kTogether = Duration::milliseconds(100);
  constexpr double kTurned_radps = 0.05;
  Turn turn;
  double products = 0.0;
  double imu_squares = 0.0;
  double wheel_squares = 0.0;
  std::size_t pairs = 0;
  auto wheel = wheels.begin();
  for (const ImuSample& sample : imu) {
    while (wheel != wheels.end() && wheel->arrival < sample.arrival) ++wheel;
    if (wheel == wheels.end()) break;
    if (wheel->arrival - sample.arrival > kTogether) continue;
    const double a = sample.rate_radps.z();
    const double b = wheel->yaw_rate_radps;
    if (!std::isfinite(a) || !std::isfinite(b)) continue;
    products += a * b;
    imu_squares += a * a;
    wheel_squares += b * b;
    ++pairs;
  }
  if (pairs == 0) return turn;
  turn.imu_rms_radps = std::sqrt(imu_squares / static_cast<double>(pairs));
  turn.wheels_rms_radps = std::sqrt(wheel_squares / static_cast<double>(pairs));
  turn.turned = turn.wheels_rms_radps > kTurned_radps;
  if (wheel_squares > 0.0) turn.gain = products / wheel_squares;
  if (wheel_squares > 0.0 && imu_squares > 0.0) {
    turn.correlation = products / std::sqrt(imu_squares * wheel_squares);
  }
  return turn;
}

Findings check_imu(const Observations& seen) {
  const TopicObservation* topic = seen.find(Role::kImu);
  if (topic == nullptr || seen.imu.empty()) return {};
  return ImuCheck(seen, *topic).run();
}

}  // namespace furrow::diagnosis
