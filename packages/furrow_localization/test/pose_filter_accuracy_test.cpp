#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

#include "simulated_drive.hpp"

namespace furrow::localization {
namespace {

using namespace test;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Errors {
  double along_square = 0.0;
  double across_square = 0.0;
  double heading_square = 0.0;
  int count = 0;
  void add(const PoseEstimate& estimate, const TruePose& truth) {
    along_square += std::pow(estimate.X_FB.x_m - truth.X_FB.x_m, 2);
    across_square += std::pow(estimate.X_FB.y_m - truth.X_FB.y_m, 2);
    heading_square += std::pow(estimate.X_FB.heading_rad - truth.X_FB.heading_rad, 2);
    ++count;
  }
  [[nodiscard]] double rms(double square) const { return std::sqrt(square / count); }
};

Errors errors_with_rtk(int gnss_hz, double skip_s) {
  Errors errors;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    DriveOptions options;
    options.gnss_hz = gnss_hz;
    const Drive drive = simulate_drive(seed, options);
    PoseFilter filter(parameters_for(options));
    std::size_t next = 0;
    for (const TruePose& truth : drive.truth) {
      for (; next < drive.measurements.size() && stamp_of(drive.measurements[next]) <= truth.stamp;
           ++next) {
        add(filter, drive.measurements[next]);
      }
      if (truth.stamp.to_seconds() < skip_s) continue;
      errors.add(*filter.predict(truth.stamp), truth);
    }
  }
  return errors;
}

TEST(PoseFilterAccuracy, KeepsToMillimetresAndTenthsOfDegreesWithRtk) {
  for (const int gnss_hz : {5, 10}) {
    const Errors errors = errors_with_rtk(gnss_hz, 10.0);
    RecordProperty("along_rms_um_" + std::to_string(gnss_hz) + "hz",
                   static_cast<int>(1e6 * errors.rms(errors.along_square)));
    RecordProperty("across_rms_um_" + std::to_string(gnss_hz) + "hz",
                   static_cast<int>(1e6 * errors.rms(errors.across_square)));
    RecordProperty("heading_rms_mdeg_" + std::to_string(gnss_hz) + "hz",
                   static_cast<int>(1e3 * errors.rms(errors.heading_square) / kDegree));
    EXPECT_LE(errors.rms(errors.along_square), 0.010);
    EXPECT_LE(errors.rms(errors.across_square), 0.010);
    EXPECT_LE(errors.rms(errors.heading_square), 0.3 * kDegree);
  }
}

TEST(PoseFilterAccuracy, DriftsLessThanOnePercentThroughATenSecondOutage) {
  double worst_share = 0.0;
  double sum_of_squares = 0.0;
  constexpr int kSeeds = 20;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const DriveOptions options;
    const Drive drive = simulate_drive(seed, options);
    PoseFilter filter(parameters_for(options));
    const Time begin = Time::from_seconds(40.0);
    const Time end = Time::from_seconds(50.0);
    for (const AnyMeasurement& measurement : drive.measurements) {
      if (stamp_of(measurement) > end) break;
      if (std::holds_alternative<GnssPosition>(measurement) && stamp_of(measurement) > begin) {
        continue;
      }
      add(filter, measurement);
    }
    const geometry::Pose2 found = filter.predict(end)->X_FB;
    const geometry::Pose2& truth = drive.truth[5000].X_FB;
    const double distance_m = truth.x_m - drive.truth[4000].X_FB.x_m;
    const double share = std::hypot(found.x_m - truth.x_m, found.y_m - truth.y_m) / distance_m;
    worst_share = std::max(worst_share, share);
    sum_of_squares += share * share;
    EXPECT_EQ(filter.health(end).level, HealthLevel::kDegraded);
  }
  RecordProperty("drift_worst_ppm", static_cast<int>(1e6 * worst_share));
  RecordProperty("drift_rms_ppm", static_cast<int>(1e6 * std::sqrt(sum_of_squares / kSeeds)));
  EXPECT_LE(worst_share, 0.01);
}

/// Normalized estimation error squared of the pose, summed over `seeds` runs at each of some
/// instants (Bar-Shalom, Li and Kirubarajan 2001, section 5.4).
std::vector<double> summed_nees(int seeds, const DriveOptions& options,
                                const PoseFilterParameters& parameters) {
  std::vector<double> nees(25, 0.0);
  for (int seed = 1; seed <= seeds; ++seed) {
    const Drive drive = simulate_drive(static_cast<std::uint64_t>(seed), options);
    PoseFilter filter(parameters);
    Random start(static_cast<std::uint64_t>(seed), "start");
    const Eigen::Vector3d sigma(0.02, 0.02, 0.02);
    const geometry::Pose2 known = {start.normal(0.0, sigma.x()), start.normal(0.0, sigma.y()),
                                   start.normal(0.0, sigma.z())};
    EXPECT_TRUE(filter.reset(Time(), known, sigma.cwiseAbs2().asDiagonal()).ok());
    std::size_t next = 0;
    for (std::size_t i = 0; i < nees.size(); ++i) {
      const TruePose& truth = drive.truth[(i + 1) * 103];
      for (; stamp_of(drive.measurements[next]) <= truth.stamp; ++next) {
        add(filter, drive.measurements[next]);
      }
      const PoseEstimate estimate = *filter.predict(truth.stamp);
      const Eigen::Vector3d error(
          estimate.X_FB.x_m - truth.X_FB.x_m, estimate.X_FB.y_m - truth.X_FB.y_m,
          geometry::wrap_angle_rad(estimate.X_FB.heading_rad - truth.X_FB.heading_rad));
      nees[i] += error.dot(estimate.covariance.inverse() * error);
    }
  }
  return nees;
}

TEST(PoseFilterAccuracy, CovarianceIsConsistentOverFiftySeeds) {
  DriveOptions options;
  options.duration_s = 27.0;
  PoseFilterParameters parameters = parameters_for(options);
  // What the simulation draws from.
  parameters.acceleration_sigma = options.speed_walk;
  parameters.yaw_acceleration_sigma = options.yaw_rate_walk;
  parameters.slip_sigma_m_per_sqrt_s = 0.0;
  parameters.initial_gyro_bias_sigma_radps = options.gyro_bias_sigma;
  parameters.initial_speed_scale_sigma = options.wheel_scale_sigma;
  parameters.initial_wheel_curvature_sigma_radpm = options.wheel_curvature_sigma;
  const std::vector<double> nees = summed_nees(50, options, parameters);
  // The sum over 50 runs of three degrees of freedom is chi-square with 150: 95 % lie in
  // [117.98, 185.80]. 25 instants: at least 20 inside (fewer has a probability below 0.2 %).
  const auto inside = std::count_if(nees.begin(), nees.end(),
                                    [](double sum) { return sum >= 117.98 && sum <= 185.80; });
  EXPECT_GE(inside, 20);
  double mean = 0.0;
  for (const double sum : nees) mean += sum / 50.0 / static_cast<double>(nees.size());
  RecordProperty("nees_mean_milli", static_cast<int>(1e3 * mean));
  RecordProperty("instants_inside", static_cast<int>(inside));
  EXPECT_NEAR(mean, 3.0, 0.4);
}

TEST(PoseFilterAccuracy, DefaultNoiseIsNotOptimistic) {
  DriveOptions options;
  options.duration_s = 27.0;
  const std::vector<double> nees = summed_nees(50, options, parameters_for(options));
  double mean = 0.0;
  for (const double sum : nees) mean += sum / 50.0 / static_cast<double>(nees.size());
  RecordProperty("nees_mean_milli", static_cast<int>(1e3 * mean));
  EXPECT_LE(mean, 3.4);
  EXPECT_GE(mean, 1.5);
}

/// CPU time of this thread for the measurements of a drive, with GNSS 100 ms late: its steps
/// include applying the later measurements again.
double cpu_time_s(double duration_s) {
  DriveOptions options;
  options.duration_s = duration_s;
  const Drive drive = simulate_drive(3, options);
  PoseFilter filter(parameters_for(options));
  std::vector<AnyMeasurement> arrivals = drive.measurements;
  std::stable_sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) {
    const auto arrival = [](const AnyMeasurement& m) {
      const bool late = std::holds_alternative<GnssPosition>(m);
      return stamp_of(m) + Duration::milliseconds(late ? 100 : 0);
    };
    return arrival(a) < arrival(b);
  });
  const auto now_s = [] {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double begin_s = now_s();
  for (const AnyMeasurement& measurement : arrivals) add(filter, measurement);
  const double spent_s = now_s() - begin_s;
  EXPECT_GT(filter.health(stamp_of(arrivals.back())).gnss.late, 8.0 * duration_s);
  return spent_s;
}

TEST(PoseFilterAccuracy, TheCostOfAMeasurementDoesNotGrowWithTheDrive) {
  // Growing with the length of the drive, eight times as long would cost 64 times as much.
  double least_ratio = 1e9;
  for (int attempt = 0; attempt < 5; ++attempt) {
    least_ratio = std::min(least_ratio, cpu_time_s(120.0) / cpu_time_s(15.0));
  }
  EXPECT_LT(least_ratio, 16.0);
}

}  // namespace
}  // namespace furrow::localization
