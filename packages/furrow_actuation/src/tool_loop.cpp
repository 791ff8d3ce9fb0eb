#include "furrow_actuation/tool_loop.hpp"

#include "furrow_actuation/call_budget.hpp"
#include "furrow_core/error.hpp"

namespace furrow::actuation {

ToolLoop::ToolLoop(AxisController& controller, AxisDriver& driver, ValveDriver& valve,
                   Duration period, double loop_deadline_s, std::function<Time()> clock)
    : controller_(controller),
      driver_(driver),
      valve_(valve),
      period_(period),
      clock_(std::move(clock)) {
  if (loop_deadline_s <= 2.0 * period.to_seconds()) {
    throw ConfigError("loop_deadline_s must be longer than two periods of the control loop");
  }
}

void ToolLoop::request_reset(Time now, SafetyCause cause) {
  controller_.safety().request_reset(cause);
  const bool waiting = controller_.safety().mode() == ControllerMode::kWaiting;
  if (cause == SafetyCause::kNone && waiting && !in_service(driver_.reading()) &&
      !supervisor_.busy()) {
    supervisor_.reset(now);
  }
}

void ToolLoop::write_valve(Time now, bool open) {
  const bool confirmed = valve_.write(now, open).ok();
  controller_.safety().valve_written(now, open, confirmed);
  report_.valve_ok = report_.valve_ok && confirmed;
  valve_open_ = open;
}

const CycleReport& ToolLoop::cycle(Time now) {
  ToolSafety& safety = controller_.safety();
  report_.valve_ok = true;
  if (valve_open_ && safety.must_shut(now)) write_valve(now, false);
  report_.read_ok = driver_.read(now, period_).ok();
  safety.set_drive_recovery(supervisor_.busy());
  controller_.set_reading(now, driver_.reading());
  report_.output = controller_.update(now, period_);
  write_valve(now, report_.output.valve_open);
  report_.valve_written = clock_();
  serve_drive(now);
  report_.write_ok = driver_.write(now, period_, report_.output.axis).ok();
  return report_;
}

void ToolLoop::serve_drive(Time now) {
  const bool wanted = controller_.safety().drive_wanted();
  if (!wanted && !supervisor_.taken_out()) supervisor_.take_out();
  if (wanted && supervisor_.taken_out()) supervisor_.reset(now);
  supervisor_.update(now, driver_);
}

StopConfirmation ToolLoop::shut_down(Time now, double at_most_s) {
  const CallBudget budget(at_most_s);
  StopConfirmation confirmed;
  supervisor_.take_out();
  do {
    confirmed.valve_shut = valve_.write(now, false).ok();
    (void)driver_.read(now, period_).ok();
    supervisor_.update(now, driver_);
    (void)driver_.write(now, period_, {}).ok();
    confirmed.power_off = supervisor_.power_off_confirmed();
    now += Duration::milliseconds(1);
  } while (!confirmed.complete() && budget.left_s() > 0.0);
  return confirmed;
}

}  // namespace furrow::actuation
