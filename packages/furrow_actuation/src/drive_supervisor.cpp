#include "furrow_actuation/drive_supervisor.hpp"

#include <cmath>

namespace furrow::actuation {

void DriveSupervisor::reset(Time now) {
  out_ = false;
  power_off_confirmed_ = false;
  wanted_ = true;
  reset_requested_ = true;
  homing_requested_ = false;
  reset_deadline_ = now + kPatience;
  next_try_ = now;
  refusal_.clear();
}

void DriveSupervisor::ask(Time now, const Status& answer) {
  next_try_ = now + kRetry;
  if (answer.ok()) {
    refusal_.clear();
  } else {
    refusal_ = answer.error().message;
  }
}

void DriveSupervisor::take_out() {
  out_ = true;
  wanted_ = false;
  reset_requested_ = false;
}

void DriveSupervisor::update(Time now, AxisDriver& driver) {
  if (out_) {
    continue_out(now, driver);
  } else if (wanted_) {
    bring_in(now, driver);
  }
}

void DriveSupervisor::continue_out(Time now, AxisDriver& driver) {
  constexpr double kStanding_mps = 1e-3;
  const AxisReading& reading = driver.reading();
  const bool fresh = reading.stamp == now;
  power_off_confirmed_ = fresh && !reading.powered;
  if (power_off_confirmed_) return;
  const bool stopped = fresh && reading.state == AxisState::kEmergencyStop &&
                       std::abs(reading.velocity_mps) < kStanding_mps;
  const Status answer = stopped ? driver.disable(now) : driver.emergency_stop(now);
  if (answer.ok()) {
    refusal_.clear();
  } else {
    refusal_ = answer.error().message;
  }
}

void DriveSupervisor::bring_in(Time now, AxisDriver& driver) {
  const AxisReading reading = driver.reading();
  switch (reading.state) {
    case AxisState::kReady:
    case AxisState::kMoving:
      wanted_ = false;
      was_in_service_ = true;
      reset_requested_ = false;
      refusal_.clear();
      return;
    case AxisState::kDisabled:
      homing_requested_ = false;
      if (now >= next_try_) ask(now, driver.enable(now));
      return;
    case AxisState::kHoming:
      if (homing_requested_ || now < next_try_) return;
      ask(now, driver.home(now));
      homing_requested_ = refusal_.empty();
      return;
    case AxisState::kFault:
    case AxisState::kEmergencyStop:
      break;
  }
  const bool absent = !was_in_service_ && reading.fault == DriveFault::kConnectionLost;
  const bool in_time = reset_requested_ && now < reset_deadline_;
  if (!absent && !in_time) {
    wanted_ = false;
    reset_requested_ = false;
  } else if (now >= next_try_) {
    homing_requested_ = false;
    ask(now, driver.reset(now));
  }
}

}  // namespace furrow::actuation
