#include "run.hpp"

#include <memory>
#include <vector>

#include "faults.hpp"

namespace furrow::actuation::campaign {
namespace {

constexpr int kTools = 2;
constexpr double kLength_s = 8.0;

/// A tool with its process, its channels and its referee.
struct Tool {
  Tool(int number, const World& world, Random& random, Tally& tally)
      : index(number),
        hardware(number),
        process(hardware, latches),
        inbox(random),
        referee(world, hardware, tally) {}
  int index;
  ToolHardware hardware;
  CauseSet latches;  ///< as the file of latches
  ToolProcess process;
  ToolInbox inbox;
  Referee referee;
  Lifecycle life;
  CauseSet reported;  ///< as the newest state message
};

class Run {
 public:
  Run(std::uint64_t seed, Tally& tally)
      : random_(seed, "campaign"), world_(random_, draw_journey(random_)) {
    faults_ = draw_faults(random_, kTools);
    resumes_ = random_.bernoulli(0.5);
    for (int i = 0; i < kTools; ++i) {
      tools_.push_back(std::make_unique<Tool>(i, world_, random_, tally));
      tools_.back()->process.start(world_.now());
    }
    for (const Fault& fault : faults_) {
      if (random_.bernoulli(0.7))
        operator_s_.push_back(fault.to.to_seconds() + random_.uniform(0.1, 1.0));
      if (random_.bernoulli(0.3))
        operator_s_.push_back(fault.from.to_seconds() + random_.uniform(0.0, 0.5));
    }
  }

  std::string play() {
    while (world_.now().to_seconds() < kLength_s) {
      for (const Fault& fault : faults_) apply(fault);
      send_messages();
      if (cycle_ % 500 == 0 && resumes_) resume();
      reset_by_operator();
      for (const auto& tool : tools_) run_tool(*tool);
      world_.advance();
      ++cycle_;
      for (const auto& tool : tools_) {
        tool->hardware.drive.advance(world_.now());
        tool->hardware.valve.advance(world_.now());
        if (std::string violated = tool->referee.judge(); !violated.empty()) {
          return "tool " + std::to_string(tool->index) + " at " +
                 std::to_string(world_.now().to_seconds()) + " s: " + violated + " [" +
                 describe(faults_) + "]";
        }
      }
    }
    return "";
  }

 private:
  static Journey draw_journey(Random& random) {
    Journey journey;
    journey.speed_mps = random.uniform(0.25, 0.8);
    if (random.bernoulli(0.4)) {
      journey.pause_at_s = random.uniform(1.0, 3.0);
      journey.pause_s = random.uniform(0.5, 2.5);
      if (random.bernoulli(0.5)) journey.back_s = random.uniform(0.1, journey.pause_s);
    }
    return journey;
  }

  void apply(const Fault& fault) {
    const Time now = world_.now();
    const bool begins = fault.from <= now && now < fault.from + kCycle;
    const bool ends = fault.to <= now && now < fault.to + kCycle;
    if (begins || ends) {
      apply_to_tool(fault, *tools_[static_cast<std::size_t>(fault.tool)], begins);
      apply_to_peers(fault, begins);
    }
  }

  void apply_to_tool(const Fault& fault, Tool& tool, bool begins) {
    const auto channel = begins ? static_cast<ChannelFault>(fault.detail) : ChannelFault::kNone;
    switch (fault.kind) {
      case FaultKind::kOdometryChannel:
        return tool.inbox.odometry.set_fault(channel);
      case FaultKind::kTracksChannel:
        return tool.inbox.tracks.set_fault(channel);
      case FaultKind::kPlanChannel:
        return tool.inbox.plan.set_fault(channel);
      case FaultKind::kHeartbeatChannel:
        return tool.inbox.heartbeat.set_fault(channel);
      case FaultKind::kToolKilled:
        if (begins) tool.process.kill();
        if (!begins && !tool.process.exists()) tool.process.start(world_.now());
        return;
      case FaultKind::kToolPaused:
        if (begins) tool.life.paused_until = fault.to;
        return;
      case FaultKind::kEmergencyStop:
        for (const auto& each : tools_) each->process.emergency_stop = begins;
        return;
      case FaultKind::kToolRaised:
        for (const auto& each : tools_) each->process.active = !begins;
        return;
      default:
        return apply_to_hardware(fault, tool, begins);
    }
  }

  void apply_to_hardware(const Fault& fault, Tool& tool, bool begins) {
    const Time now = world_.now();
    SimulatedAxisDriver& drive = tool.hardware.drive;
    const bool drive_bus =
        fault.kind == FaultKind::kDriveBusLost || fault.kind == FaultKind::kWholeBusLost;
    const bool valve_bus =
        fault.kind == FaultKind::kValveBusLost || fault.kind == FaultKind::kWholeBusLost;
    if (drive_bus) drive.set_connected(now, !begins);
    if (valve_bus) {
      tool.hardware.valve.set_connected(!begins);
      tool.referee.valve_connected(!begins);
    }
    if (fault.kind == FaultKind::kDriveFault && begins) drive.inject(now, DriveFault::kDrive);
    if (fault.kind == FaultKind::kDriveFault && !begins) drive.clear_faults();
    if (fault.kind == FaultKind::kDriveJammed) drive.set_jammed(begins);
    if (fault.kind == FaultKind::kValveTrouble) {
      tool.hardware.valve.set_trouble(begins ? static_cast<ValveTrouble>(fault.detail)
                                             : ValveTrouble::kNone);
    }
  }

  void apply_to_peers(const Fault& fault, bool begins) {
    const Duration step = Duration::seconds(fault.clock_step_s);
    switch (fault.kind) {
      case FaultKind::kPlannerKilled:
        planner_.life.dead_until = fault.to;
        return planner_.forget();
      case FaultKind::kPlannerPaused:
        planner_.life.paused_until = fault.to;
        return;
      case FaultKind::kLocalizationKilled:
        localization_.dead_until = fault.to;
        if (!begins) localization_offset_ = step;
        return;
      case FaultKind::kLocalizationPaused:
        localization_.paused_until = fault.to;
        return;
      case FaultKind::kTrackerKilled:
        tracker_.life.dead_until = fault.to;
        if (!begins) tracker_.clock_offset = step;
        return tracker_.forget();
      case FaultKind::kTrackerPaused:
        tracker_.life.paused_until = fault.to;
        return;
      case FaultKind::kClockStep:
        localization_offset_ = begins ? step : Duration();
        return;
      default:
        return;
    }
  }

  void send_messages() {
    const Time now = world_.now();
    if (cycle_ % 5 == 0 && localization_.runs(now)) {
      BaseState base = world_.base();
      base.stamp += localization_offset_;
      base.X_FB.x_m += random_.normal(0.0, 5e-4);
      base.X_FB.y_m += random_.normal(0.0, 5e-4);
      for (const auto& tool : tools_) tool->inbox.odometry.send(now, base);
    }
    if (cycle_ % 50 == 0 && tracker_.life.runs(now)) {
      const TracksMessage tracks = tracker_.look(world_);
      for (const auto& tool : tools_) tool->inbox.tracks.send(now, tracks);
      if (planner_.life.runs(now)) plan(tracks);
    }
    if (cycle_ % 10 == 0 && planner_.life.runs(now)) {
      for (const auto& tool : tools_) tool->inbox.heartbeat.send(now, {});
    }
  }

  void plan(const TracksMessage& tracks) {
    planner_.take(tracks, world_.base());
    for (const auto& tool : tools_) {
      tool->inbox.plan.send(world_.now(), planner_.plan(tool->index, kTools));
    }
  }

  void run_tool(Tool& tool) {
    if (!tool.process.exists() || !tool.life.runs(world_.now())) {
      tool.referee.missed_cycle();
      return;
    }
    const bool stop = tool.process.emergency_stop;
    const bool active = tool.process.active;
    tool.referee.saw(tool.process.cycle(world_.now(), tool.inbox), stop, active);
    tool.reported = tool.process.controller().safety().latched();
  }

  void request(Tool& tool, SafetyCause cause) {
    if (!tool.process.exists() || !tool.life.runs(world_.now())) return;
    tool.process.loop().request_reset(world_.now(), cause);
    tool.referee.reset_sent(cause);
  }

  /// As `furrow up --resume`: lost peers and nothing else.
  void resume() {
    for (const auto& tool : tools_) {
      for (const SafetyCause cause : tool->reported.list()) {
        if (rule_of(cause).lost_peer) request(*tool, cause);
      }
    }
  }

  void reset_by_operator() {
    for (const double at_s : operator_s_) {
      const double since_s = world_.now().to_seconds() - at_s;
      if (since_s < 0.0 || since_s >= kCycle.to_seconds()) continue;
      for (const auto& tool : tools_) request(*tool, SafetyCause::kNone);
    }
  }

  Random random_;
  World world_;
  std::vector<Fault> faults_;
  std::vector<double> operator_s_;
  bool resumes_ = false;
  TrackerProcess tracker_;
  PlannerProcess planner_;
  Lifecycle localization_;
  Duration localization_offset_;
  std::vector<std::unique_ptr<Tool>> tools_;
  std::int64_t cycle_ = 0;
};

}  // namespace

std::string run(std::uint64_t seed, Tally& tally) {
  return Run(seed, tally).play();
}

}  // namespace furrow::actuation::campaign
