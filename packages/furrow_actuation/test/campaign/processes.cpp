#include "processes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace furrow::actuation::campaign {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

ToolInbox::ToolInbox(Random& random)
    : odometry(random, [](BaseState& message) { message.X_FB.x_m = kNan; }),
      tracks(random,
             [](TracksMessage& message) {
               for (SeenPlant& seen : message.plants) seen.plant.p_F.x() = kNan;
             }),
      plan(random,
           [](PlanMessage& message) {
             for (PlannedStop& stop : message.stops) stop.p_F.y() = kNan;
           }),
      heartbeat(random, [](HeartbeatMessage&) {}) {}

TracksMessage TrackerProcess::look(const World& world) {
  const double x_m = world.base().X_FB.x_m;
  const Time stamp = world.now() + clock_offset;
  for (const TruePlant& plant : world.plants()) {
    const double ahead_m = plant.p_F.x() - x_m;
    if (kFrom_m <= ahead_m && ahead_m <= kTo_m) memory_[plant.id] = {plant, stamp};
  }
  TracksMessage message{stamp, {}};
  for (const auto& [id, seen] : memory_) message.plants.push_back(seen);
  return message;
}

void PlannerProcess::take(const TracksMessage& tracks, const BaseState& base) {
  tracks_ = tracks;
  geometry::AxisModel at_base = axis_model(0);
  at_base.p_BN0.x() = 0.0;
  const double landing_m = drop_landing(base, at_base, 0.0, 0.0).x();
  passed_B_m_ = std::max(passed_B_m_.value_or(landing_m), landing_m);
}

PlanMessage PlannerProcess::plan(int axis, int axes) const {
  PlanMessage message;
  for (const SeenPlant& seen : tracks_->plants) {
    if (seen.plant.crop || seen.plant.id % axes != axis) continue;
    const bool beside = std::ranges::any_of(tracks_->plants, [&](const SeenPlant& other) {
      return other.plant.crop && (other.plant.p_F - seen.plant.p_F).norm() < kZone_m;
    });
    const bool passed = seen.plant.p_F.x() <= *passed_B_m_ + axis_model(axis).p_BN0.x();
    if (beside || passed) continue;
    PlannedStop stop;
    stop.stop_id = seen.plant.id;
    stop.targets.push_back(seen.plant.id);
    stop.p_F = seen.plant.p_F;
    stop.observed = seen.last_seen;
    message.stops.push_back(stop);
  }
  std::ranges::sort(message.stops, {}, [](const PlannedStop& stop) { return stop.p_F.x(); });
  if (message.stops.size() > kMaxPlanStops) message.stops.resize(kMaxPlanStops);
  return message;
}

AxisControllerParameters ToolProcess::parameters() {
  AxisControllerParameters parameters;
  // Less than the way from where plants are first seen to the nozzle takes at the greatest speed.
  parameters.safety.tracks_deadline_s = 1.0;
  return parameters;
}

ToolProcess::Parts::Parts(ToolHardware& hardware, Time& now)
    : controller(hardware.model, {}, parameters()),
      valve(hardware.valve),
      loop(controller, hardware.drive, valve, kCycle, parameters().safety.loop_deadline_s,
           [&now] { return now; }) {}

ToolProcess::ToolProcess(ToolHardware& hardware, CauseSet& kept_latches)
    : hardware_(hardware), kept_latches_(kept_latches) {}

void ToolProcess::start(Time now) {
  parts_ = std::make_unique<Parts>(hardware_, now_);
  parts_->controller.safety().restore(kept_latches_, now);
  started_ = now;
}

void ToolProcess::take(const TracksMessage& tracks) {
  std::vector<ProtectedPlant> crops;
  for (const SeenPlant& seen : tracks.plants) {
    if (seen.plant.crop) crops.push_back({seen.plant.id, seen.plant.p_F});
  }
  controller().set_protected(tracks.newest_image, crops);
}

const CycleReport& ToolProcess::cycle(Time now, ToolInbox& inbox) {
  now_ = now;
  ToolSafety& safety = controller().safety();
  inbox.odometry.receive(now, [&](const BaseState& base) { controller().set_odometry(now, base); });
  inbox.tracks.receive(now, [&](const TracksMessage& tracks) { take(tracks); });
  inbox.plan.receive(
      now, [&](const PlanMessage& plan) { (void)controller().set_plan(now, plan.stops).ok(); });
  inbox.heartbeat.receive(now, [&](const HeartbeatMessage&) { safety.heartbeat_came(now); });
  safety.set_emergency_stop(emergency_stop);
  safety.set_active(active);
  const CycleReport& report = parts_->loop.cycle(now);
  kept_latches_ = safety.latched();
  return report;
}

}  // namespace furrow::actuation::campaign
