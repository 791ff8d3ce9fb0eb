#include "faults.hpp"

#include <array>

namespace furrow::actuation::campaign {
namespace {

constexpr std::array<std::string_view, kFaultKinds> kNames = {
    "odometry channel", "tracks channel", "plan channel",        "heartbeat channel",
    "planner killed",   "planner paused", "localization killed", "localization paused",
    "tracker killed",   "tracker paused", "tool killed",         "tool paused",
    "drive fault",      "drive jammed",   "drive bus lost",      "valve bus lost",
    "whole bus lost",   "valve trouble",  "emergency stop",      "tool raised",
    "clock step"};

int draw_detail(Random& random, FaultKind kind) {
  constexpr int kChannelFaults = 6;
  constexpr int kValveTroubles = 5;
  const bool channel = kind <= FaultKind::kHeartbeatChannel;
  return static_cast<int>(random.integer(1, channel ? kChannelFaults : kValveTroubles));
}

}  // namespace

std::string_view to_string(FaultKind kind) {
  return kNames[static_cast<std::size_t>(kind)];
}

std::vector<Fault> draw_faults(Random& random, int tools) {
  std::vector<Fault> faults(static_cast<std::size_t>(random.integer(1, 4)));
  for (Fault& fault : faults) {
    fault.kind = static_cast<FaultKind>(random.integer(0, kFaultKinds - 1));
    fault.tool = static_cast<int>(random.integer(0, tools - 1));
    fault.detail = draw_detail(random, fault.kind);
    const double sign = random.bernoulli(0.5) ? 1.0 : -1.0;
    fault.clock_step_s = sign * (random.bernoulli(0.5) ? random.uniform(0.02, 0.5) : 3600.0);
    fault.from = Time::from_seconds(random.uniform(0.3, 4.5));
    const double length_s =
        random.bernoulli(0.3) ? random.uniform(0.004, 0.08) : random.uniform(0.08, 1.8);
    fault.to = fault.from + Duration::seconds(length_s);
  }
  return faults;
}

std::string describe(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) {
    text += std::string(to_string(fault.kind)) + " (tool " + std::to_string(fault.tool) +
            ", detail " + std::to_string(fault.detail) + ") " +
            std::to_string(fault.from.to_seconds()) + " to " +
            std::to_string(fault.to.to_seconds()) + " s; ";
  }
  return text;
}

}  // namespace furrow::actuation::campaign
