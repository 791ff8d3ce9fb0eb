#include "furrow_actuation/drive_supervisor.hpp"

namespace furrow::actuation {

void DriveSupervisor::reset(Time now) {
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

void DriveSupervisor::update(Time now, AxisDriver& driver) {
  if (!wanted_) return;
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
