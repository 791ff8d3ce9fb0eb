#pragma once

#include <gtest/gtest.h>

#include <mutex>
#include <thread>

#include "../simulator/drive_server.hpp"
#include "furrow_actuation/modbus_axis_driver.hpp"

namespace furrow::actuation::cia402 {

using drive_simulator::DriveServer;
using drive_simulator::SimulatedDrive;
using Phase = SimulatedDrive::Phase;

inline constexpr MotionLimits kLimits{-0.695, 0.695, 1.0, 10.0, 1000.0};

/// A driver against the drive over a real connection on the loopback. The drive's time moves by one
/// millisecond with each request, so nothing here depends on the machine's speed.
class Wire {
 public:
  explicit Wire(const ModbusAxisParameters& base = {})
      : server_(drive, "127.0.0.1", 0), driver_(kLimits, parameters(server_.port(), base)) {
    thread_ = std::thread([this] {
      server_.serve([this] {
        const std::lock_guard lock(mutex);
        if (cut_) return false;
        drive.advance(1e-3);
        return true;
      });
    });
  }
  ~Wire() {
    server_.stop();
    thread_.join();
  }
  static ModbusAxisParameters parameters(int port, const ModbusAxisParameters& base = {}) {
    ModbusAxisParameters p = base;
    p.port = port;
    p.timeout_s = 2.0;
    p.homing_speed_mps = 0.5;
    p.homing_acceleration_mps2 = 5.0;
    return p;
  }

  bool cycle(const AxisCommand& command = {}) {
    now_ += Duration::milliseconds(10);
    const bool connected = driver().read(now_, Duration::milliseconds(10)).ok();
    wrote = driver().write(now_, Duration::milliseconds(10), command).ok();
    return connected;
  }
  void run_until(AxisState state, int most = 3000) {
    for (int i = 0; i < most && driver().reading().state != state; ++i) cycle();
    ASSERT_EQ(driver().reading().state, state);
  }
  void make_ready() {
    cycle();
    ASSERT_TRUE(driver().enable(now_).ok());
    run_until(AxisState::kHoming);
    ASSERT_TRUE(driver().home(now_).ok());
    run_until(AxisState::kReady);
  }
  template <class Change>
  void at_drive(Change change) {
    const std::lock_guard lock(mutex);
    change(drive);
  }
  void cut(bool cut) {
    const std::lock_guard lock(mutex);
    cut_ = cut;
  }
  ModbusAxisDriver& driver() { return driver_; }
  [[nodiscard]] Time now() const { return now_; }

  SimulatedDrive drive;
  std::mutex mutex;
  bool wrote = false;

 private:
  DriveServer server_;
  ModbusAxisDriver driver_;
  std::thread thread_;
  bool cut_ = false;
  Time now_ = Time::from_seconds(1.0);
};

}  // namespace furrow::actuation::cia402
