#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>

#include "furrow_core/parameters.hpp"
#include "furrow_core/random.hpp"
#include "furrow_core/time.hpp"
#include "furrow_simulation/robot_motion.hpp"

namespace furrow::simulation {

// Simulated sensors: each reads the true state at its time. With their default parameters all of
// them are exact. A sensor is read at its own rate, in the order of time; its noise depends only on
// the seed and on the sequence of readings.

struct WheelOdometryParameters {
  double speed_scale = 1.0;
  double speed_noise_mps = 0.0;
  double yaw_rate_scale = 1.0;
  double yaw_rate_noise_radps = 0.0;
  double yaw_rate_bias_radps = 0.0;
  void visit(ParameterVisitor& v);
};

struct WheelReading {
  Time time;
  double speed_mps = 0.0;  ///< of the wheels: slip is in it
  double yaw_rate_radps = 0.0;
};

class WheelOdometry {
 public:
  WheelOdometry(const WheelOdometryParameters& parameters, std::uint64_t seed);
  [[nodiscard]] WheelReading measure(const RobotState& state);

 private:
  WheelOdometryParameters parameters_;
  Random random_;
};

struct ImuParameters {
  double gyro_noise_radps = 0.0;
  double gyro_bias_radps = 0.0;
  double gyro_bias_walk_radps_per_sqrt_s = 0.0;
  double accelerometer_noise_mps2 = 0.0;
  double accelerometer_bias_mps2 = 0.0;
  void visit(ParameterVisitor& v);
};

struct ImuReading {
  Time time;
  Eigen::Vector3d angular_velocity_B_radps = Eigen::Vector3d::Zero();
  /// Specific force in B: at rest +9.80665 along z.
  Eigen::Vector3d acceleration_B_mps2 = Eigen::Vector3d::Zero();
};

class Imu {
 public:
  Imu(const ImuParameters& parameters, std::uint64_t seed);
  [[nodiscard]] ImuReading measure(const RobotState& state);
  [[nodiscard]] double gyro_bias_radps() const { return bias_radps_; }

 private:
  ImuParameters parameters_;
  Random random_;
  double bias_radps_;
  std::optional<Time> last_;
};

enum class GnssQuality : std::uint8_t { kNone, kSingle, kFloat, kFixed };

struct GnssParameters {
  double antenna_x_m = 0.0;  ///< in B
  double antenna_y_m = 0.0;
  double fixed_noise_m = 0.0;  ///< standard deviation of each coordinate
  double float_noise_m = 0.0;
  double single_noise_m = 0.0;
  double latency_s = 0.0;
  double degraded_per_min = 0.0;  ///< the fix is lost: single, then float
  double degraded_mean_s = 5.0;
  double outages_per_min = 0.0;
  double outage_mean_s = 3.0;
  double jumps_per_min = 0.0;  ///< a wrong fix: displaced, and still called fixed
  double jump_m = 0.1;
  double jump_mean_s = 2.0;
  void visit(ParameterVisitor& v);
};

struct GnssReading {
  Time time;       ///< when the antenna was there
  Time available;  ///< when the receiver publishes it
  GnssQuality quality = GnssQuality::kFixed;
  Eigen::Vector2d p_F_m = Eigen::Vector2d::Zero();  ///< the antenna
  double standard_deviation_m = 0.0;                ///< as the receiver claims it
};

class Gnss {
 public:
  Gnss(const GnssParameters& parameters, std::uint64_t seed);
  /// Nothing during an outage.
  [[nodiscard]] std::optional<GnssReading> measure(const RobotState& state);

 private:
  /// A condition that comes and goes, after exponential times and for exponential times.
  class Episode {
   public:
    Episode(double per_min, double mean_s, std::uint64_t seed, std::string_view stream)
        : per_min_(per_min), mean_s_(mean_s), random_(seed, stream) {}
    /// True while it lasts; `began` then tells whether this is another one than at the last call.
    bool update(Time now);
    [[nodiscard]] bool began() const { return began_; }
    [[nodiscard]] bool in_first_half(Time now) const { return now - start_ < end_ - now; }

   private:
    double per_min_;
    double mean_s_;
    Random random_;
    Time start_;
    Time end_;
    bool scheduled_ = false;
    bool entered_ = false;
    bool began_ = false;
  };

  GnssParameters parameters_;
  Random random_;
  Episode degraded_;
  Episode outage_;
  Episode jump_;
  Eigen::Vector2d jump_F_m_ = Eigen::Vector2d::Zero();
};

}  // namespace furrow::simulation
