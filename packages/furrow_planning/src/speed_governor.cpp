#include "furrow_planning/speed_governor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "furrow_core/error.hpp"

namespace furrow::planning {
namespace {

constexpr double kStep_m = 0.01;
constexpr std::size_t kSteps = 250;  ///< further than a camera sees
constexpr std::int64_t kLeastPlans = 2;
constexpr std::int64_t kMostPlans = 100;
constexpr int kMostLeads = 3;
constexpr double kHarder = 1.25;
constexpr double kFollows_mps = 0.05;  ///< what is faster than asked by more does not follow

void require(bool condition, std::string_view message) {
  if (!condition) throw ConfigError(message);
}

bool positive(double value) {
  return std::isfinite(value) && value > 0.0;
}

bool not_negative(double value) {
  return std::isfinite(value) && value >= 0.0;
}

/// Where the weight left, summed along the row, first exceeds that which is left anyway.
std::optional<LeftTarget> first_excess(std::span<const LeftTarget> left,
                                       std::span<const LeftTarget> anyway,
                                       double tolerated_weight) {
  constexpr double kRounding = 1e-9;
  double excess = -tolerated_weight - kRounding;
  auto other = anyway.begin();
  for (const LeftTarget& target : left) {
    for (; other != anyway.end() && other->x_m <= target.x_m; ++other) excess -= other->weight;
    excess += target.weight;
    if (excess > 0.0) return target;
  }
  return std::nullopt;
}

}  // namespace

void SpeedGovernorParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "min_speed_mps",
           .unit = "m/s",
           .description = "the least speed that is asked for",
           .min = 0.05,
           .max = 10.0},
          min_speed_mps);
  v.visit({.name = "speed_step_mps",
           .unit = "m/s",
           .description = "by which a stretch is made slower at a time until its weeds are reached",
           .min = 0.005,
           .max = 1.0},
          speed_step_mps);
  v.visit({.name = "acceleration_mps2",
           .unit = "m/s2",
           .description = "by which the speed that is asked for changes at most, up and down",
           .min = 0.01,
           .max = 10.0},
          acceleration_mps2);
  v.visit({.name = "lead_m",
           .unit = "m",
           .description = "way before the foremost axis meets a weed over which the robot is as "
                          "slow as the weed asks",
           .min = 0.0,
           .max = 2.0},
          lead_m);
  v.visit({.name = "tolerated_weight",
           .description = "weeds ahead of this weight together are left rather than slowed for",
           .min = 0.0},
          tolerated_weight);
  v.visit({.name = "most_planned_targets",
           .description = "in all plans that are tried for one image, of which there are two at "
                          "least; then what was found so far holds",
           .min = 1,
           .max = 1e6},
          most_planned_targets);
}

SpeedGovernor::SpeedGovernor(const SpeedGovernorParameters& parameters, double row_speed_mps,
                             double front_m, double rear_m)
    : parameters_(parameters),
      row_speed_mps_(row_speed_mps),
      front_m_(front_m),
      rear_m_(rear_m),
      expected_(SpeedProfile::constant(row_speed_mps)) {
  require(std::isfinite(front_m) && std::isfinite(rear_m) && rear_m <= front_m,
          "the places of the axes are not sound");
  require(positive(parameters.min_speed_mps), "min_speed_mps is not positive");
  require(parameters.min_speed_mps <= row_speed_mps, "min_speed_mps is above the row's speed");
  require(positive(parameters.speed_step_mps), "speed_step_mps is not positive");
  require(positive(parameters.acceleration_mps2), "acceleration_mps2 is not positive");
  require(not_negative(parameters.lead_m), "lead_m is negative");
  require(parameters.most_planned_targets >= 1, "most_planned_targets is not positive");
  require(not_negative(parameters.tolerated_weight), "tolerated_weight is negative");
}

Status SpeedGovernor::consider(const GovernedRobot& robot, const LeftAtSpeeds& left_at) {
  if (!std::isfinite(robot.x_m) || !std::isfinite(robot.speed_mps) ||
      !std::isfinite(robot.committed_until_x_m)) {
    return Error{ErrorCode::kInvalidArgument, "the robot's place or speed is not finite"};
  }
  from_x_m_ = robot.x_m;
  limit_by_promise(robot);
  unsaved_.clear();
  fill(row_speed_mps_);
  SpeedProfile asked = drivable(robot, 1.0);
  bool compared = false;
  int leads = 1;
  const std::int64_t most_plans =
      std::clamp(parameters_.most_planned_targets / std::max<std::int64_t>(robot.targets, 1),
                 kLeastPlans, kMostPlans);
  for (std::int64_t plan = 0; plan < most_plans; ++plan) {
    const auto left = left_at(with_excess(asked, robot));
    if (!left.ok()) return left.error();
    left_.assign(left->begin(), left->end());
    if (!left_.empty() && !compared) {
      compared = true;
      if (Status status = find_unsaved(robot, left_at); !status) return status;
    }
    const auto excess = first_excess(left_, unsaved_, parameters_.tolerated_weight);
    if (!excess) break;
    // Slow enough already beside the weed: what comes before it takes the time.
    while (!slow_down_for(excess->x_m, leads * parameters_.lead_m) && leads <= kMostLeads) ++leads;
    if (leads <= kMostLeads) {
      asked = drivable(robot, 1.0);
    } else {
      unsaved_.insert(std::ranges::upper_bound(unsaved_, excess->x_m, {}, &LeftTarget::x_m),
                      *excess);
      leads = 1;
    }
  }
  expected_ = with_excess(asked, robot);
  asked_ = std::move(asked);
  return {};
}

/// As if the robot could brake a little harder: a weed for which it brakes is not given up because
/// it brakes a little late.
Status SpeedGovernor::find_unsaved(const GovernedRobot& robot, const LeftAtSpeeds& left_at) {
  fill(parameters_.min_speed_mps);
  const auto left = left_at(drivable(robot, kHarder));
  fill(row_speed_mps_);
  if (!left.ok()) return left.error();
  unsaved_.assign(left->begin(), left->end());
  return {};
}

void SpeedGovernor::fill(double cap_mps) {
  caps_mps_.assign(kSteps, cap_mps);
}

void SpeedGovernor::limit_by_promise(const GovernedRobot& robot) {
  promise_mps_.assign(kSteps, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double x_m = from_x_m_ + static_cast<double>(i) * kStep_m;
    if (i > 0 && x_m > robot.committed_until_x_m) break;
    promise_mps_[i] = request_mps(x_m);
  }
}

/// False when the robot is as slow there as it may be asked to be.
bool SpeedGovernor::slow_down_for(double weed_x_m, double lead_m) {
  const auto step_at = [&](double x_m) {
    const double steps =
        std::clamp(std::round((x_m - from_x_m_) / kStep_m), 0.0, static_cast<double>(kSteps - 1));
    return static_cast<std::ptrdiff_t>(steps);
  };
  const auto first = caps_mps_.begin() + step_at(weed_x_m - front_m_ - lead_m);
  const auto last = caps_mps_.begin() + step_at(weed_x_m - rear_m_) + 1;
  const double fastest_mps = *std::max_element(first, last);
  if (fastest_mps <= parameters_.min_speed_mps) return false;
  const double cap_mps =
      std::max(parameters_.min_speed_mps, fastest_mps - parameters_.speed_step_mps);
  std::transform(first, last, first, [&](double cap) { return std::min(cap, cap_mps); });
  return true;
}

SpeedProfile SpeedGovernor::drivable(const GovernedRobot& robot, double harder) const {
  std::vector<double> speeds(kSteps);
  const double gain =
      2.0 * harder * parameters_.acceleration_mps2 * kStep_m;  // of the squared speed
  speeds[0] = request_mps(robot.x_m);
  for (std::size_t i = 1; i < kSteps; ++i) {
    speeds[i] =
        std::min({caps_mps_[i], promise_mps_[i], std::sqrt(speeds[i - 1] * speeds[i - 1] + gain)});
  }
  for (std::size_t i = kSteps - 1; i-- > 0;) {
    speeds[i] = std::min(speeds[i], std::sqrt(speeds[i + 1] * speeds[i + 1] + gain));
  }
  // What it cannot brake for in time, it brakes for as it can.
  double squared = request_mps(robot.x_m) * request_mps(robot.x_m);
  for (double& speed : speeds) {
    speed = std::max(speed, std::sqrt(std::max(0.0, squared)));
    squared -= gain;
  }
  return {from_x_m_, kStep_m, std::move(speeds)};
}

SpeedProfile SpeedGovernor::with_excess(const SpeedProfile& asked,
                                        const GovernedRobot& robot) const {
  const double excess_mps = robot.speed_mps - asked.speed_mps(robot.x_m);
  if (excess_mps <= 0.0) return asked;
  const double most_mps = std::max(row_speed_mps_, robot.speed_mps);
  const double least_mps = excess_mps > kFollows_mps ? robot.speed_mps : 0.0;
  std::vector<double> speeds(kSteps);
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double x_m = from_x_m_ + static_cast<double>(i) * kStep_m;
    speeds[i] = std::clamp(asked.speed_mps(x_m) + excess_mps, least_mps, most_mps);
  }
  return {from_x_m_, kStep_m, std::move(speeds)};
}

double SpeedGovernor::request_mps(double robot_x_m) const {
  return asked_ ? asked_->speed_mps(robot_x_m) : row_speed_mps_;
}

}  // namespace furrow::planning
