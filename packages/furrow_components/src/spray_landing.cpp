#include "spray_landing.hpp"

#include <algorithm>
#include <utility>

#include "furrow_components/conversions.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/enums.hpp"

namespace furrow::components {

SprayLanding::SprayLanding(graph::Context& context, geometry::ToolModel tool,
                           const simulation::SprayParameters& parameters,
                           const simulation::ValveFaultParameters& faults, Duration odometry_gap)
    : context_(context),
      tool_(std::move(tool)),
      parameters_(parameters),
      odometry_gap_(odometry_gap),
      out_(context.output<msgs::topics::TrueSpray>()),
      faults_(faults) {
  for (std::size_t i = 0; i < tool_.axes.size(); ++i) {
    valves_.emplace(tool_.axes[i].name,
                    Valve{simulation::SimulatedValve(parameters_, context.seed(), i), {}, {}, {}});
  }
}

void SprayLanding::take(const furrow_msgs::msg::AxisState& state) {
  const auto valve = valves_.find(state.axis());
  if (valve == valves_.end()) return;
  valve->second.axis =
      AxisPoint{graph::from_msg(state.header().stamp()), state.position_m(), state.velocity_mps()};
}

simulation::ValveFault SprayLanding::fault_of(const std::string& axis, Time time) const {
  return start_ ? faults_.at(axis, time - *start_) : simulation::ValveFault::kNone;
}

void SprayLanding::take(const furrow_msgs::msg::AxisEvent& event) {
  if (event.event() != msgs::AxisEventKind::kSprayed) return;
  const auto axis = std::ranges::find(tool_.axes, event.axis(), &geometry::AxisModel::name);
  if (axis == tool_.axes.end()) {
    context_.warn("events_of_unknown_axes",
                  "the tool has no axis '" + event.axis() + "'; its spray does not land");
    return;
  }
  Valve& valve = valves_.at(event.axis());
  const Time opened = graph::from_msg(event.opened());
  const Time closed = graph::from_msg(event.closed());
  valve.valve.set_fault(fault_of(event.axis(), opened));
  auto window = valve.valve.actuate(opened, closed);
  if (window && !window->close) {
    // It stays open: this spray is as long as it was meant to be, the rest is not commanded.
    if (!valve.opened_in_fault) valve.opened_in_fault = closed;
    window->close = closed;
  }
  if (!window || *window->close <= window->open) {
    context_.count("openings_without_spray");
    return;
  }
  constexpr std::size_t kMostAtOnce = 1000;
  if (falling_.size() == kMostAtOnce) {
    context_.warn("sprays_beyond_the_limit",
                  "more than 1000 sprays are in the air; a spray does not land");
    return;
  }
  falling_.push_back({event, window->open, *window->close, &*axis});
}

// Where a spray lands is known when its last drop has left: the robot drives on until then.
bool SprayLanding::move(const nav_msgs::msg::Odometry& truth) {
  const BaseOdometry base = from_msg(truth);
  if (!truth_.add(base).ok()) return false;
  const auto has_left = [now = base.stamp](const Falling& spray) { return spray.close <= now; };
  for (const Falling& spray : falling_) {
    if (has_left(spray)) land(spray);
  }
  std::erase_if(falling_, has_left);
  if (!start_) start_ = base.stamp;
  if (!faults_.empty()) release_uncommanded(base.stamp);
  return true;
}

void SprayLanding::release_uncommanded(Time now) {
  for (const geometry::AxisModel& model : tool_.axes) {
    Valve& valve = valves_.at(model.name);
    const simulation::ValveFault fault = fault_of(model.name, now);
    const bool leaks = fault == simulation::ValveFault::kLeaking;
    if (fault != simulation::ValveFault::kStuckOpen) valve.opened_in_fault.reset();
    if ((!leaks && !valve.opened_in_fault) || !valve.axis) {
      valve.released_until.reset();
      continue;
    }
    if (!valve.released_until) valve.released_until = valve.opened_in_fault.value_or(now);
    for (; *valve.released_until + kSlice <= now; *valve.released_until += kSlice) {
      land_slice(model, *valve.axis, *valve.released_until, *valve.released_until + kSlice);
    }
  }
}

void SprayLanding::land_slice(const geometry::AxisModel& model, const AxisPoint& axis, Time from,
                              Time to) {
  const auto at = [&](Time time) {
    const double ahead_s = (time - axis.time).to_seconds();
    return nozzle(model, {time, axis.position_m + axis.velocity_mps * ahead_s, axis.velocity_mps});
  };
  const auto first = at(from);
  const auto last = at(to);
  if (!first || !last) return;
  context_.warn("uncommanded_sprays",
                "simulated fault: the valve of " + model.name + " releases without a command");
  furrow_msgs::msg::AxisEvent event;
  event.axis(model.name);
  const auto patch = simulation::spray_patch(*first, *last, model.nozzle.height_m, parameters_);
  event.aim(to_point(patch.p_F_m));
  publish(event, patch, model.nozzle.footprint_radius_m);
}

void SprayLanding::land(const Falling& spray) {
  const auto& event = spray.event;
  // The driver measured its axis this long after each command.
  const Time closed = graph::from_msg(event.closed());
  const Duration delay = graph::from_msg(event.header().stamp()) - closed;
  const AxisPoint first{graph::from_msg(event.opened()) + delay, event.position_opened_m(),
                        event.velocity_opened_mps()};
  const AxisPoint last{closed + delay, event.position_closed_m(), event.velocity_closed_mps()};
  const auto at_open = nozzle(*spray.axis, axis_at(first, last, spray.open));
  const auto at_close = nozzle(*spray.axis, axis_at(first, last, spray.close));
  if (!at_open || !at_close) {
    context_.warn("sprays_outside_the_memory",
                  "no true pose at the time of a spray; it does not land");
    return;
  }
  const geometry::NozzleModel& model = spray.axis->nozzle;
  publish(event, simulation::spray_patch(*at_open, *at_close, model.height_m, parameters_),
          model.footprint_radius_m);
}

void SprayLanding::publish(const furrow_msgs::msg::AxisEvent& event,
                           const simulation::SprayPatch& patch, double radius_m) const {
  furrow_msgs::msg::TrueSpray spray;
  spray.header(header(patch.time, kFieldFrame));
  spray.axis(event.axis());
  spray.stop_id(event.stop_id());
  spray.track_ids(event.track_ids());
  spray.aim(event.aim());
  spray.centre(to_point(patch.p_F_m));
  spray.radius_m(radius_m);
  out_.publish(std::move(spray));
}

// The nozzle over the true ground.
std::optional<simulation::NozzleState> SprayLanding::nozzle(const geometry::AxisModel& model,
                                                            const AxisPoint& axis) const {
  const auto base = truth_.at(axis.time, odometry_gap_);
  if (!base.ok()) return std::nullopt;
  const Eigen::Vector2d p_B = model.nozzle_position_B(axis.position_m).head<2>();
  const Eigen::Vector2d v_B = Eigen::Vector2d(base->speed_mps, 0.0) +
                              base->yaw_rate_radps * Eigen::Vector2d(-p_B.y(), p_B.x()) +
                              axis.velocity_mps * model.direction_B.head<2>();
  const Eigen::Rotation2Dd R_FB(base->X_FB.heading_rad);
  return simulation::NozzleState{axis.time, geometry::transform(base->X_FB, p_B), R_FB * v_B};
}

}  // namespace furrow::components
