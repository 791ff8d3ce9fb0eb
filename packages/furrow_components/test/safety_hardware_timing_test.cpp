// How soon an emergency stop reaches the devices themselves, in real time. A simulated output
// module and a simulated CiA 402 drive are on the loopback, each on a dedicated thread.

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>

#include "../../furrow_actuation/simulator/drive_server.hpp"
#include "../../furrow_actuation/simulator/output_module.hpp"
#include "furrow_core/test_support/undisturbed_rounds.hpp"
#include "safety_repetitions.hpp"

namespace furrow::components::safety_timing {
namespace {

using actuation::drive_simulator::DriveServer;
using actuation::drive_simulator::OutputModule;
using actuation::drive_simulator::SimulatedDrive;
using Clock = std::chrono::steady_clock;

/// Both devices, and when they did what.
class Devices {
 public:
  Devices() : server_(drive_, "127.0.0.1", 0) {
    drive_.on_phase([this](SimulatedDrive::Phase phase) {
      const std::lock_guard lock(mutex_);
      if (phase == SimulatedDrive::Phase::kQuickStop) quick_stops_.push_back(Clock::now());
      if (phase == SimulatedDrive::Phase::kLocked) power_offs_.push_back(Clock::now());
    });
    module.on_coil([this](std::size_t, bool level, Clock::time_point at) {
      if (level) return;
      module.set_delay(std::chrono::milliseconds(0));
      const std::lock_guard lock(mutex_);
      coil_offs_.push_back(at);
    });
    thread_ = std::thread([this] {
      auto last = Clock::now();
      const auto pass_time = [&] {
        const auto now = Clock::now();
        drive_.advance(std::chrono::duration<double>(now - last).count());
        last = now;
        return true;
      };
      server_.serve(pass_time, [&] { (void)pass_time(); });
    });
  }
  ~Devices() {
    server_.stop();
    thread_.join();
  }
  Devices(const Devices&) = delete;
  Devices& operator=(const Devices&) = delete;

  [[nodiscard]] std::map<std::string, ParameterValue> parameters() const {
    return {{"driver", std::string("cia402_modbus")},
            {"drive_port", std::int64_t{server_.port()}},
            {"drive_homing_speed_mps", 0.5},
            {"drive_homing_acceleration_mps2", 5.0},
            {"valve", std::string("modbus_coils")},
            {"coil_port", std::int64_t{module.port()}},
            {"coil_watchdog", std::string("wago_750")},
            {"rate_hz", 200.0}};
  }
  /// When it first happened at or after `time`.
  enum class What { kCoilOff, kQuickStop, kPowerOff };
  [[nodiscard]] std::optional<double> after_ms(What what, Clock::time_point time) {
    const std::lock_guard lock(mutex_);
    const auto& list = what == What::kCoilOff     ? coil_offs_
                       : what == What::kQuickStop ? quick_stops_
                                                  : power_offs_;
    const auto first = std::ranges::lower_bound(list, time);
    if (first == list.end()) return std::nullopt;
    return std::chrono::duration<double, std::milli>(*first - time).count();
  }

  OutputModule module;

 private:
  SimulatedDrive drive_;
  DriveServer server_;
  std::thread thread_;
  std::mutex mutex_;
  std::vector<Clock::time_point> coil_offs_;    // under mutex_
  std::vector<Clock::time_point> quick_stops_;  // under mutex_
  std::vector<Clock::time_point> power_offs_;   // under mutex_
};

/// The longest times from the cause to valve and drive, in ms.
struct Longest {
  double coil_off_ms = 0.0;
  double quick_stop_ms = 0.0;
};

Longest measure(const std::string& name, const std::function<void(OutputModule&)>& disturb) {
  Devices devices;
  Outcome outcome;
  outcome.before_cause = [&] { disturb(devices.module); };
  Longest longest;
  if (!repeat(Cause::kEmergencyStop, outcome, devices.parameters())) {
    longest.coil_off_ms = std::numeric_limits<double>::infinity();
    return longest;
  }
  int powered_off = 0;
  for (const Clock::time_point cause : outcome.caused) {
    const auto coil_ms = devices.after_ms(Devices::What::kCoilOff, cause);
    const auto stop_ms = devices.after_ms(Devices::What::kQuickStop, cause);
    const auto off_ms = devices.after_ms(Devices::What::kPowerOff, cause);
    EXPECT_TRUE(coil_ms && stop_ms) << name;
    if (!coil_ms || !stop_ms) continue;
    longest.coil_off_ms = std::max(longest.coil_off_ms, *coil_ms);
    longest.quick_stop_ms = std::max(longest.quick_stop_ms, *stop_ms);
    if (off_ms && *off_ms > *stop_ms) ++powered_off;
  }
  // The run ends with its last repetition: its power goes off at the exit.
  EXPECT_GE(powered_off + 1, static_cast<int>(outcome.caused.size())) << name;
  std::printf(
      "%s: coil off at the module after p100 %.2f ms, quick stop at the drive after p100 "
      "%.2f ms, of %zu\n",
      name.c_str(), longest.coil_off_ms, longest.quick_stop_ms, outcome.caused.size());
  return longest;
}

void expect_within_20_ms(const std::string& name,
                         const std::function<void(OutputModule&)>& disturb) {
  expect_within_in_an_undisturbed_round(20.0, name, [&] {
    const Longest longest = measure(name, disturb);
    return std::max(longest.coil_off_ms, longest.quick_stop_ms);
  });
}

TEST(SafetyHardwareTiming, QuickStopReachesTheDriveAndTheCoilGoesOff) {
  expect_within_20_ms("module answers", [](OutputModule&) {});
}

TEST(SafetyHardwareTiming, TheCoilGoesOffWhileTheModuleAnswersLate) {
  expect_within_20_ms("module answers late", [](OutputModule& module) {
    module.set_delay(std::chrono::milliseconds(12));
  });
}

TEST(SafetyHardwareTiming, TheCoilGoesOffAlthoughAReplyIsLost) {
  expect_within_20_ms("reply lost", [](OutputModule& module) { module.lose_reply(); });
}

TEST(SafetyHardwareTiming, TheCoilGoesOffAfterTheModuleHangsUp) {
  expect_within_20_ms("module hangs up", [](OutputModule& module) { module.hang_up(); });
}

}  // namespace
}  // namespace furrow::components::safety_timing
