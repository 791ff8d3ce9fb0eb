#include "furrow_localization/pose_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "covariance.hpp"
#include "motion_model.hpp"
#include "ring_buffer.hpp"

namespace furrow::localization {
namespace {

constexpr double kMaxPosition_m = 1e7;
constexpr double kMaxRate = 100.0;  // m/s and rad/s: beyond any field robot

/// The order of the alternatives is the order in which measurements of one stamp are applied.
using AnyMeasurement = std::variant<WheelOdometry, ImuYawRate, GnssPosition>;

bool is_variance(double value) {
  return std::isfinite(value) && value > 0.0;
}
bool is_rate(double value) {
  return std::abs(value) <= kMaxRate;
}

bool is_valid(const WheelOdometry& m) {
  return is_rate(m.speed_mps) && is_rate(m.yaw_rate_radps) && is_variance(m.speed_variance) &&
         is_variance(m.yaw_rate_variance);
}

bool is_valid(const ImuYawRate& m) {
  return is_rate(m.yaw_rate_radps) && is_variance(m.yaw_rate_variance);
}

bool is_valid(const GnssPosition& m) {
  return m.p_FA_m.allFinite() && m.p_FA_m.cwiseAbs().maxCoeff() <= kMaxPosition_m &&
         (!m.covariance || is_definite(*m.covariance));
}

struct Entry {
  Time stamp = {};
  AnyMeasurement measurement = {};
  FilterState after = {};
};

double age_s(Time now, const std::optional<Time>& newest) {
  return newest ? (now - *newest).to_seconds() : std::numeric_limits<double>::infinity();
}

}  // namespace

class PoseFilter::Impl {
 public:
  explicit Impl(const PoseFilterParameters& parameters)
      : parameters_((validate_parameters(parameters), parameters)),
        model_(parameters_),
        history_(static_cast<std::size_t>(parameters.history_measurements)) {}

  Status reset(Time stamp, const geometry::Pose2& X_FB, const Eigen::Matrix3d& covariance);
  template <class Measurement>
  Outcome add(const Measurement& measurement, SensorCounts& counts, std::optional<Time>& newest);
  [[nodiscard]] Result<PoseEstimate> predict(Time stamp) const;
  [[nodiscard]] LocalizationHealth health(Time now) const;

  const PoseFilterParameters parameters_;
  SensorCounts odometry_;
  SensorCounts imu_;
  SensorCounts gnss_;
  std::optional<Time> newest_odometry_;
  std::optional<Time> newest_imu_;
  std::optional<Time> newest_gnss_;
  FixQuality fix_quality_ = FixQuality::kNone;

 private:
  void start(Time stamp);
  Outcome insert(Time stamp, const AnyMeasurement& measurement);
  [[nodiscard]] bool is_too_far_ahead(Time stamp);
  void begin_again(Time stamp);
  void forget_old();
  Outcome apply(std::size_t index);
  [[nodiscard]] const FilterState& newest() const {
    return history_.empty() ? base_ : history_.back().after;
  }

  MotionModel model_;
  bool started_ = false;
  FilterState base_;  ///< before the first measurement of the history
  RingBuffer<Entry> history_;
  std::int64_t far_ahead_ = 0;  ///< measurements in a row
};

Status PoseFilter::Impl::reset(Time stamp, const geometry::Pose2& X_FB,
                               const Eigen::Matrix3d& covariance) {
  if (!std::isfinite(X_FB.x_m) || !std::isfinite(X_FB.y_m) || !std::isfinite(X_FB.heading_rad)) {
    return Error{ErrorCode::kInvalidArgument, "the pose is not finite"};
  }
  if (!is_semi_definite(covariance)) {
    return Error{ErrorCode::kInvalidArgument, "the covariance is not positive semi-definite"};
  }
  history_.clear();
  base_ = model_.initial_state(stamp, X_FB, covariance);
  started_ = true;
  far_ahead_ = 0;
  newest_odometry_.reset();
  newest_imu_.reset();
  newest_gnss_.reset();
  fix_quality_ = FixQuality::kNone;
  return {};
}

void PoseFilter::Impl::start(Time stamp) {
  const double position = std::pow(parameters_.initial_position_sigma_m, 2);
  const double heading = std::pow(parameters_.initial_heading_sigma_rad, 2);
  const Eigen::Matrix3d covariance = Eigen::Vector3d(position, position, heading).asDiagonal();
  base_ = model_.initial_state(
      stamp, {parameters_.initial_x_m, parameters_.initial_y_m, parameters_.initial_heading_rad},
      covariance);
  started_ = true;
}

bool PoseFilter::Impl::is_too_far_ahead(Time stamp) {
  if ((stamp - newest().stamp).to_seconds() <= parameters_.max_jump_ahead_s) {
    far_ahead_ = 0;
    return false;
  }
  return ++far_ahead_ < parameters_.gnss_recovery_repeats;
}

void PoseFilter::Impl::begin_again(Time stamp) {
  const PoseEstimate last = MotionModel::estimate(newest());
  Eigen::Matrix3d covariance = last.covariance;
  covariance.diagonal() +=
      Eigen::Vector3d(parameters_.initial_position_sigma_m, parameters_.initial_position_sigma_m,
                      parameters_.initial_heading_sigma_rad)
          .cwiseAbs2();
  history_.clear();
  base_ = model_.initial_state(stamp, last.X_FB, covariance);
  far_ahead_ = 0;
}

template <class Measurement>
Outcome PoseFilter::Impl::add(const Measurement& measurement, SensorCounts& counts,
                              std::optional<Time>& newest_of_kind) {
  Outcome outcome = Outcome::kInvalid;
  if (is_valid(measurement)) {
    if (!started_) start(measurement.stamp);
    if (measurement.stamp < base_.stamp) {
      outcome = Outcome::kTooOld;
    } else if (!is_too_far_ahead(measurement.stamp)) {
      if ((measurement.stamp - newest().stamp).to_seconds() > parameters_.max_jump_ahead_s) {
        begin_again(measurement.stamp);
      }
      outcome = insert(measurement.stamp, measurement);
    }
  }
  counts.count(outcome);
  const bool used =
      outcome == Outcome::kUsed || outcome == Outcome::kUsedLate || outcome == Outcome::kRecovered;
  if (used && (!newest_of_kind || measurement.stamp > *newest_of_kind)) {
    newest_of_kind = measurement.stamp;
    if constexpr (std::is_same_v<Measurement, GnssPosition>) fix_quality_ = measurement.quality;
  }
  return outcome;
}

Outcome PoseFilter::Impl::insert(Time stamp, const AnyMeasurement& measurement) {
  const auto before = [&](const Entry& entry) {
    return entry.stamp != stamp ? entry.stamp < stamp
                                : entry.measurement.index() < measurement.index();
  };
  std::size_t place = history_.size();
  while (place > 0 && !before(history_[place - 1])) --place;
  if (place < history_.size() && history_[place].stamp == stamp &&
      history_[place].measurement.index() == measurement.index()) {
    return Outcome::kDuplicate;
  }
  if (history_.full()) {
    if (place == 0) return Outcome::kTooOld;
    base_ = history_.front().after;
    history_.pop_front();
    --place;
  }
  const bool late = place < history_.size();
  Entry& entry = history_.insert(place);
  entry.stamp = stamp;
  entry.measurement = measurement;
  const Outcome outcome = apply(place);
  for (std::size_t i = place + 1; i < history_.size(); ++i) apply(i);
  forget_old();
  return late && outcome == Outcome::kUsed ? Outcome::kUsedLate : outcome;
}

Outcome PoseFilter::Impl::apply(std::size_t index) {
  Entry& entry = history_[index];
  entry.after = index == 0 ? base_ : history_[index - 1].after;
  model_.predict(entry.after, entry.stamp);
  return std::visit([&](const auto& m) { return model_.update(entry.after, m); },
                    entry.measurement);
}

void PoseFilter::Impl::forget_old() {
  const Time oldest = history_.back().stamp - Duration::seconds(parameters_.history_s);
  while (history_.size() > 1 && history_.front().stamp < oldest) {
    base_ = history_.front().after;
    history_.pop_front();
  }
}

Result<PoseEstimate> PoseFilter::Impl::predict(Time stamp) const {
  if (!started_) return Error{ErrorCode::kUnavailable, "no measurement has come yet"};
  if (stamp < base_.stamp) {
    return Error{ErrorCode::kStale, "the time is before the filter's history"};
  }
  if ((stamp - newest().stamp).to_seconds() > parameters_.max_extrapolation_s) {
    return Error{ErrorCode::kStale, "the time is too far after the newest measurement"};
  }
  std::size_t i = history_.size();
  while (i > 0 && history_[i - 1].stamp > stamp) --i;
  FilterState state = i > 0 ? history_[i - 1].after : base_;
  model_.predict(state, stamp);
  return MotionModel::estimate(state);
}

LocalizationHealth PoseFilter::Impl::health(Time now) const {
  LocalizationHealth health;
  health.odometry = odometry_;
  health.imu = imu_;
  health.gnss = gnss_;
  health.odometry_age_s = age_s(now, newest_odometry_);
  health.imu_age_s = age_s(now, newest_imu_);
  health.gnss_age_s = age_s(now, newest_gnss_);
  health.fix_quality = fix_quality_;
  if (!started_) {
    health.position_sigma_m = std::numeric_limits<double>::infinity();
    health.heading_sigma_rad = std::numeric_limits<double>::infinity();
    return health;
  }
  const FilterState& state = newest();
  health.position_sigma_m = std::sqrt(greatest_variance(state.P.topLeftCorner<2, 2>()));
  health.heading_sigma_rad = std::sqrt(state.P(kHeading, kHeading));
  const bool silent = (now - state.stamp).to_seconds() > parameters_.max_extrapolation_s;
  const bool odometry_late =
      parameters_.use_odometry && health.odometry_age_s > parameters_.odometry_timeout_s;
  const bool gnss_late = parameters_.use_gnss && health.gnss_age_s > parameters_.gnss_timeout_s;
  const bool coarse_fix = parameters_.use_gnss && fix_quality_ != FixQuality::kRtkFixed;
  if (silent || !(health.position_sigma_m <= parameters_.lost_position_sigma_m)) {
    health.level = HealthLevel::kLost;
  } else if (odometry_late || gnss_late || coarse_fix ||
             health.position_sigma_m > parameters_.degraded_position_sigma_m) {
    health.level = HealthLevel::kDegraded;
  } else {
    health.level = HealthLevel::kOk;
  }
  return health;
}

PoseFilter::PoseFilter(const PoseFilterParameters& parameters)
    : impl_(std::make_unique<Impl>(parameters)) {}
PoseFilter::~PoseFilter() = default;
PoseFilter::PoseFilter(PoseFilter&&) noexcept = default;
PoseFilter& PoseFilter::operator=(PoseFilter&&) noexcept = default;

Status PoseFilter::reset(Time stamp, const geometry::Pose2& X_FB,
                         const Eigen::Matrix3d& covariance) {
  return impl_->reset(stamp, X_FB, covariance);
}

Outcome PoseFilter::add(const WheelOdometry& measurement) {
  if (!impl_->parameters_.use_odometry) {
    impl_->odometry_.count(Outcome::kIgnored);
    return Outcome::kIgnored;
  }
  return impl_->add(measurement, impl_->odometry_, impl_->newest_odometry_);
}

Outcome PoseFilter::add(const ImuYawRate& measurement) {
  if (!impl_->parameters_.use_imu) {
    impl_->imu_.count(Outcome::kIgnored);
    return Outcome::kIgnored;
  }
  return impl_->add(measurement, impl_->imu_, impl_->newest_imu_);
}

Outcome PoseFilter::add(const GnssPosition& measurement) {
  if (!impl_->parameters_.use_gnss) {
    impl_->gnss_.count(Outcome::kIgnored);
    return Outcome::kIgnored;
  }
  if (measurement.quality == FixQuality::kNone) {
    impl_->gnss_.count(Outcome::kNoFix);
    return Outcome::kNoFix;
  }
  return impl_->add(measurement, impl_->gnss_, impl_->newest_gnss_);
}

Result<PoseEstimate> PoseFilter::predict(Time stamp) const {
  return impl_->predict(stamp);
}
LocalizationHealth PoseFilter::health(Time now) const {
  return impl_->health(now);
}

}  // namespace furrow::localization
