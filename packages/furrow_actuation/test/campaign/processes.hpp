#pragma once

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "channel.hpp"
#include "furrow_actuation/tool_loop.hpp"
#include "hardware.hpp"
#include "world.hpp"

namespace furrow::actuation::campaign {

struct SeenPlant {
  TruePlant plant;
  Time last_seen;
};
struct TracksMessage {
  Time newest_image;
  std::vector<SeenPlant> plants;
};
struct PlanMessage {
  std::vector<PlannedStop> stops;
};
struct HeartbeatMessage {};

/// The channels into one tool's process.
struct ToolInbox {
  explicit ToolInbox(Random& random);
  Channel<BaseState> odometry;
  Channel<TracksMessage> tracks;
  Channel<PlanMessage> plan;
  Channel<HeartbeatMessage> heartbeat;
};

/// A process that may be dead, or stopped by a signal.
struct Lifecycle {
  std::optional<Time> dead_until;
  std::optional<Time> paused_until;
  [[nodiscard]] bool runs(Time now) const {
    return !(dead_until && now < *dead_until) && !(paused_until && now < *paused_until);
  }
};

/// Camera, detector and tracker: what lies ahead is seen, what was seen is remembered.
class TrackerProcess {
 public:
  static constexpr double kFrom_m = 0.30;
  static constexpr double kTo_m = 1.50;
  Lifecycle life;
  Duration clock_offset;
  void forget() { memory_.clear(); }
  [[nodiscard]] TracksMessage look(const World& world);

 private:
  std::map<std::int64_t, SeenPlant> memory_;
};

/// Gives each weed that is not beside a crop to an axis; a plan for each tracks message. As the
/// planner's views do, it finishes what the robot has passed, at the furthest point that it
/// reached.
class PlannerProcess {
 public:
  static constexpr double kZone_m = 0.040;
  Lifecycle life;
  void take(const TracksMessage& tracks, const BaseState& base);
  void forget() {
    tracks_.reset();
    passed_B_m_.reset();
  }
  [[nodiscard]] bool ready() const { return tracks_.has_value(); }
  [[nodiscard]] PlanMessage plan(int axis, int axes) const;

 private:
  std::optional<TracksMessage> tracks_;
  /// Where drops landed at most that left at the origin of the base, along the row.
  std::optional<double> passed_B_m_;
};

/// The driver's process of one tool. What it had latched survives it.
class ToolProcess {
 public:
  ToolProcess(ToolHardware& hardware, CauseSet& kept_latches);

  void start(Time now);
  void kill() { parts_.reset(); }
  [[nodiscard]] bool exists() const { return parts_ != nullptr; }
  /// One cycle: takes what has arrived, and runs the loop.
  const CycleReport& cycle(Time now, ToolInbox& inbox);
  [[nodiscard]] AxisController& controller() { return parts_->controller; }
  [[nodiscard]] ToolLoop& loop() { return parts_->loop; }
  [[nodiscard]] Time started() const { return started_; }

  bool emergency_stop = false;  ///< the latched topics: a restart finds them again
  bool active = true;

 private:
  struct Parts {
    Parts(ToolHardware& hardware, Time& now);
    AxisController controller;
    ValveClient valve;
    ToolLoop loop;
  };
  static AxisControllerParameters parameters();
  void take(const TracksMessage& tracks);

  ToolHardware& hardware_;
  CauseSet& kept_latches_;
  std::unique_ptr<Parts> parts_;
  Time now_;
  Time started_;
};

}  // namespace furrow::actuation::campaign
