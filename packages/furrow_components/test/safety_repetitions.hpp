#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "feeder.hpp"
#include "furrow_components/conversions.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_graph/stamp.hpp"
#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/nav_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::components::safety_timing {

namespace topics = msgs::topics;

/// Of each cause; FURROW_SAFETY_REPETITIONS changes it.
inline std::size_t repetitions() {
  const char* text = std::getenv("FURROW_SAFETY_REPETITIONS");
  return text == nullptr ? 100 : std::strtoul(text, nullptr, 10);
}

inline constexpr double kSpeed_mps = 0.5;

enum class Cause { kEmergencyStop, kOdometryInvalid, kPlannerSilent };

/// What the driver latches.
inline std::string latched_by(Cause cause) {
  switch (cause) {
    case Cause::kEmergencyStop:
      return "emergency_stop";
    case Cause::kOdometryInvalid:
      return "odometry_invalid";
    case Cause::kPlannerSilent:
      return "peer_lost";
  }
  return "";
}

struct Outcome {
  /// Called when the cause is brought about, before its message is published.
  std::function<void()> before_cause = [] {};
  std::vector<double> shut_after_ms;
  std::vector<std::chrono::steady_clock::time_point> caused;
  /// What latched although the feeder had not brought it about: a busy machine delays messages.
  std::map<std::string, int> unexpected;
};

/// Robot, tracker and planner in one: drives on, has one plant after the other sprayed for long,
/// and brings the cause about while the valve is open. Resets what latches besides, and gives up
/// when nothing happens for kPatience.
class Feeder final : public graph::Component {
 public:
  Feeder(graph::Context& context, Cause cause, Outcome& outcome)
      : context_(context),
        cause_(cause),
        outcome_(outcome),
        plan_out_(context.output<topics::Plan>()),
        heartbeat_out_(context.output<topics::PlannerHeartbeat>()),
        odometry_out_(context.output<topics::RobotOdometry>()),
        tracks_out_(context.output<topics::Tracks>()),
        stop_out_(context.output<topics::EmergencyStop>()),
        reset_out_(context.output<topics::ToolReset>()) {
    context.every(Duration::milliseconds(10), [this](Time now) { step(now); });
    context.every(Duration::milliseconds(20), [this](Time) { beat(); });
    context.input<topics::AxisState>([this](const auto& state) { watch(*state); });
    context.input<topics::AxisEvent>([this](const auto& event) { take(*event); });
  }

  static void describe(graph::Description& d) {
    d.input<topics::AxisState>()
        .input<topics::AxisEvent>()
        .output<topics::Plan>()
        .output<topics::PlannerHeartbeat>()
        .output<topics::RobotOdometry>()
        .output<topics::Tracks>()
        .output<topics::EmergencyStop>()
        .output<topics::ToolReset>();
  }

 private:
  [[nodiscard]] double x_m(Time time) const { return kSpeed_mps * (time - start_).to_seconds(); }

  void step(Time now) {
    if (start_ == Time()) start_ = now;
    if (!odometry_broken_) {
      odometry_out_.publish(
          to_msg(BaseOdometry{now, {x_m(now), 0.0, 0.0}, kSpeed_mps, 0.0}, kFieldFrame));
    }
    if (progress_ == Time()) progress_ = now;
    if (now - progress_ > kPatience) {
      std::string latched;
      for (const auto& cause : latched_) latched += " " + std::string(msgs::to_string(cause));
      context_.request_stop("no progress; mode " + mode_ + ", latched:" + latched);
      return;
    }
    if (!latched_.empty() && now - reset_ > Duration::milliseconds(200)) reset(now);
    if (!waiting_for_valve_) return;
    if (planned_ && now - *planned_ < Duration::milliseconds(500)) return;
    planned_ = now;
    furrow_msgs::msg::Plan plan;
    plan.header(header(now, kFieldFrame));
    auto& route = plan.routes().emplace_back();
    route.axis("axis_1");
    auto& stop = route.stops().emplace_back();
    stop.id(++stops_);
    // A little ahead of where the nozzle (0.18 m before the base) will be when it may open.
    stop.aim(to_point(Eigen::Vector2d(x_m(now) + 0.18 + 0.095, 0.0)));
    stop.track_ids({stops_});
    stop.observed(graph::to_msg(now));
    plan_out_.publish(std::move(plan));
    furrow_msgs::msg::Tracks tracks;
    tracks.header(header(now, kFieldFrame));
    tracks_out_.publish(std::move(tracks));
  }

  void beat() {
    if (silent_) return;
    last_beat_ = context_.now();
    furrow_msgs::msg::Heartbeat heartbeat;
    heartbeat.header(header(last_beat_, ""));
    heartbeat_out_.publish(std::move(heartbeat));
  }

  void reset(Time now) {
    reset_ = now;
    reset_out_.publish(furrow_msgs::msg::ToolReset());
  }

  void watch(const furrow_msgs::msg::AxisState& state) {
    mode_ = msgs::to_string(state.mode());
    latched_.assign(state.latched().begin(), state.latched().end());
    if (!waiting_for_valve_ || state.openings() == openings_) return;
    openings_ = state.openings();
    waiting_for_valve_ = false;
    disturbed_ = false;
    progress_ = context_.now();
    planned_.reset();
    outcome_.before_cause();
    caused_ = context_.now();
    outcome_.caused.push_back(std::chrono::steady_clock::now());
    switch (cause_) {
      case Cause::kEmergencyStop:
        stop_out_.publish(emergency_stop(true));
        break;
      case Cause::kOdometryInvalid:
        odometry_broken_ = true;
        odometry_out_.publish(to_msg(
            BaseOdometry{caused_, {std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}, 0.5, 0.0},
            kFieldFrame));
        break;
      case Cause::kPlannerSilent:
        silent_ = true;
        caused_ = last_beat_;  // dead since then, as far as the driver can know
        break;
    }
  }

  static furrow_msgs::msg::EmergencyStop emergency_stop(bool active) {
    furrow_msgs::msg::EmergencyStop message;
    message.active(active);
    return message;
  }

  void take(const furrow_msgs::msg::AxisEvent& event) {
    if (event.event() == msgs::AxisEventKind::kReset) {
      waiting_for_valve_ = true;
      return;
    }
    if (event.event() != msgs::AxisEventKind::kSafeState) return;
    const std::string told(msgs::to_string(event.cause()));
    if (waiting_for_valve_ || told != latched_by(cause_)) {
      ++outcome_.unexpected[told];
      disturbed_ = true;
      return;
    }
    if (disturbed_) {
      outcome_.caused.pop_back();  // the valve may have been shut for another cause
    } else {
      outcome_.shut_after_ms.push_back(1e3 *
                                       (graph::from_msg(event.closed()) - caused_).to_seconds());
    }
    if (outcome_.shut_after_ms.size() == repetitions()) {
      context_.request_stop("enough");
      return;
    }
    end_cause();
  }

  void end_cause() {
    progress_ = context_.now();
    silent_ = false;
    odometry_broken_ = false;
    beat();
    stop_out_.publish(emergency_stop(false));
    odometry_out_.publish(
        to_msg(BaseOdometry{context_.now(), {x_m(context_.now()), 0.0, 0.0}, kSpeed_mps, 0.0},
               kFieldFrame));
    reset(context_.now());
  }

  static constexpr Duration kPatience = Duration::milliseconds(10'000);

  graph::Context& context_;
  Cause cause_;
  Outcome& outcome_;
  graph::Output<topics::Plan> plan_out_;
  graph::Output<topics::PlannerHeartbeat> heartbeat_out_;
  graph::Output<topics::RobotOdometry> odometry_out_;
  graph::Output<topics::Tracks> tracks_out_;
  graph::Output<topics::EmergencyStop> stop_out_;
  graph::Output<topics::ToolReset> reset_out_;
  Time start_;
  Time caused_;
  Time last_beat_;
  Time reset_;     // when one was last asked for
  Time progress_;  // when the valve last opened or shut
  std::string mode_;
  std::vector<furrow_msgs::msg::SafetyCause> latched_;
  std::optional<Time> planned_;
  std::int64_t stops_ = 0;
  std::uint64_t openings_ = 0;
  bool waiting_for_valve_ = true;
  bool disturbed_ = false;  // another cause latched since the valve opened
  bool silent_ = false;
  bool odometry_broken_ = false;
};

/// Whether all repetitions took place, each with the cause that was brought about; what disturbed
/// them is printed. `parameters` are of the driver, beside those that every repetition needs.
[[nodiscard]] inline bool repeat(Cause cause, Outcome& outcome,
                                 const std::map<std::string, ParameterValue>& parameters = {}) {
  graph::Registry registry;
  registry.load_library(FURROW_AXIS_DRIVER_LIBRARY);
  registry.add(feeder_class<Feeder>(cause, outcome));
  graph::GraphSpec spec;
  spec.components = {{.name = "driver",
                      .group = "driver",
                      .class_name = "axis_driver",
                      .parameters = {{"tool_file", std::string(FURROW_TOOL_FILE), {}},
                                     {"axis", std::string("axis_1"), {}},
                                     {"dwell_s", 0.2, {}},
                                     {"placement_tolerance_m", 0.1, {}},
                                     {"state_rate_hz", 500.0, {}}},
                      .dedicated_thread = true,
                      .priority = 60},
                     {.name = "feeder",
                      .group = "feeder",
                      .class_name = "feeder",
                      .dedicated_thread = true,
                      .priority = 50}};
  for (const auto& [name, value] : parameters) {
    spec.components[0].parameters.push_back({name, value, {}});
  }
  graph::Runtime runtime(spec, registry, {.clock = graph::ClockMode::kReal, .threads = 1});
  const std::string reason = runtime.run().reason;
  for (const auto& [what, times] : outcome.unexpected) {
    std::printf("latched besides: %s, %d times\n", what.c_str(), times);
  }
  if (reason != "enough") std::printf("%s\n", reason.c_str());
  return reason == "enough";
}

}  // namespace furrow::components::safety_timing
