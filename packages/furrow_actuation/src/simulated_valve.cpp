#include <algorithm>
#include <cmath>

#include "furrow_actuation/nozzle.hpp"
#include "furrow_core/error.hpp"

namespace furrow::actuation {

std::string_view to_string(ValveFault fault) {
  switch (fault) {
    case ValveFault::kNone:
      return "none";
    case ValveFault::kStuckOpen:
      return "stuck_open";
    case ValveFault::kStuckClosed:
      return "stuck_closed";
    case ValveFault::kBlocked:
      return "blocked";
  }
  return "unknown";
}

void SimulatedValveParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "open_delay_s",
           .unit = "s",
           .description = "from the command to flow",
           .min = 0.0,
           .max = 0.5},
          open_delay_s);
  v.visit({.name = "close_delay_s",
           .unit = "s",
           .description = "from the command to no flow",
           .min = 0.0,
           .max = 0.5},
          close_delay_s);
  v.visit({.name = "jitter_s",
           .unit = "s",
           .description = "standard deviation of each delay",
           .min = 0.0,
           .max = 0.1},
          jitter_s);
}

SimulatedValve::SimulatedValve(const SimulatedValveParameters& parameters, std::uint64_t seed,
                               std::string_view name)
    : parameters_(parameters), random_(seed, name) {
  if (!(parameters.open_delay_s >= 0.0 && parameters.close_delay_s >= 0.0 &&
        parameters.jitter_s >= 0.0)) {
    throw ConfigError("simulated valve: delays and jitter must not be negative");
  }
}

Status SimulatedValve::write(Time time, bool open) {
  if (open == commanded_) return {};
  if (pending_.size() == kMaxPending) {
    return Error{ErrorCode::kUnavailable, "the simulated valve's changes were not taken"};
  }
  commanded_ = open;
  const double delay_s = open ? parameters_.open_delay_s : parameters_.close_delay_s;
  const double jitter_s =
      parameters_.jitter_s > 0.0 ? random_.normal(0.0, parameters_.jitter_s) : 0.0;
  if (fault_ == ValveFault::kNone) {
    schedule(time + Duration::seconds(std::max(0.0, delay_s + jitter_s)), open);
  }
  return {};
}

void SimulatedValve::inject(Time time, ValveFault fault) {
  BoundedVector<FlowChange, kMaxPending> kept;
  last_scheduled_ = flowing_;
  for (const FlowChange& change : pending_) {
    if (change.time <= time) {
      kept.push_back(change);
      last_scheduled_ = change.flowing;
    }
  }
  pending_ = kept;
  fault_ = fault;
  schedule(time, fault == ValveFault::kStuckOpen || (fault == ValveFault::kNone && commanded_));
}

void SimulatedValve::schedule(Time time, bool flowing) {
  if (flowing == last_scheduled_) return;
  last_scheduled_ = flowing;
  if (!pending_.empty()) time = std::max(time, pending_.back().time);
  pending_.push_back({time, flowing});
}

BoundedVector<SimulatedValve::FlowChange, SimulatedValve::kMaxPending> SimulatedValve::take_changes(
    Time time) {
  BoundedVector<FlowChange, kMaxPending> taken;
  while (!pending_.empty() && pending_.front().time <= time) {
    taken.push_back(pending_.front());
    flowing_ = pending_.front().flowing;
    pending_.erase_front();
  }
  return taken;
}

}  // namespace furrow::actuation
