#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "furrow_core/random.hpp"
#include "furrow_core/time.hpp"

namespace furrow::actuation::campaign {

enum class FaultKind {
  kOdometryChannel,  ///< these four: by `detail`, a ChannelFault
  kTracksChannel,
  kPlanChannel,
  kHeartbeatChannel,
  kPlannerKilled,
  kPlannerPaused,
  kLocalizationKilled,  ///< restarts with another clock
  kLocalizationPaused,
  kTrackerKilled,  ///< restarts with another clock, without its memory
  kTrackerPaused,
  kToolKilled,
  kToolPaused,
  kDriveFault,
  kDriveJammed,
  kDriveBusLost,
  kValveBusLost,
  kWholeBusLost,
  kValveTrouble,  ///< by `detail`, a ValveTrouble
  kEmergencyStop,
  kToolRaised,
  kClockStep,  ///< of the localization
};
inline constexpr int kFaultKinds = 21;
[[nodiscard]] std::string_view to_string(FaultKind kind);

/// A fault over a stretch of time, at one tool where it concerns one.
struct Fault {
  FaultKind kind = FaultKind::kOdometryChannel;
  int tool = 0;
  int detail = 0;
  double clock_step_s = 0.0;
  Time from;
  Time to;
};

/// One to four faults.
[[nodiscard]] std::vector<Fault> draw_faults(Random& random, int tools);
[[nodiscard]] std::string describe(const std::vector<Fault>& faults);

}  // namespace furrow::actuation::campaign
