#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hardware.hpp"
#include "processes.hpp"

namespace furrow::actuation::campaign {

/// What happened in one run.
struct Tally {
  int sprays = 0;
  int latched = 0;
  int resets = 0;
  int refused = 0;
  int skipped = 0;
  int overrun_cycles = 0;  ///< drops after their process was dead, stopped or cut off
  double longest_overrun_s = 0.0;
};

/// Watches one tool with the eyes of the ground truth.
class Referee {
 public:
  Referee(const World& world, const ToolHardware& hardware, Tally& tally)
      : world_(world), hardware_(hardware), tally_(tally) {}

  /// A reset of `cause` (kNone: all) was published.
  void reset_sent(SafetyCause cause);
  /// The process ran a cycle.
  void saw(const CycleReport& report, bool emergency_stop, bool active);
  /// The process is dead, or did not run in this cycle.
  void missed_cycle() { in_control_ = false; }
  /// The driver's connection to the valve holds.
  void valve_connected(bool connected) { valve_connected_ = connected; }
  /// After each cycle of the hardware. Returns what is violated, or empty.
  [[nodiscard]] std::string judge();

 private:
  [[nodiscard]] std::string judge_flow();
  [[nodiscard]] std::string judge_landing() const;
  [[nodiscard]] std::string judge_motion() const;
  void note(const ControllerEvent& event);

  const World& world_;
  const ToolHardware& hardware_;
  Tally& tally_;
  bool in_control_ = false;
  bool valve_connected_ = true;
  bool wanted_open_ = false;
  std::optional<Time> last_wanted_;      ///< the process wanted the valve open, and could tell it
  std::optional<Time> trouble_until_;    ///< the valve itself was at fault
  CauseSet waiting_for_reset_;           ///< latched, and no reset was published since
  std::map<std::int64_t, int> sprayed_;  ///< openings for a target
  std::string found_;
};

}  // namespace furrow::actuation::campaign
