#include "furrow_actuation/gpio_valve.hpp"

#include "furrow_core/error.hpp"

namespace furrow::actuation {

void GpioValveParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "chip", .description = "name or path of the GPIO chip"}, chip);
  v.visit({.name = "line", .description = "line of the chip, from 0", .min = 0, .max = 1023}, line);
  v.visit({.name = "active_low", .description = "a low level opens the valve"}, active_low);
}

GpioValve::GpioValve(std::unique_ptr<GpioLine> line, bool active_low)
    : line_(std::move(line)), active_low_(active_low) {
  known_ = line_->set(active_low_).ok();
}

GpioValve::~GpioValve() {
  (void)line_->set(active_low_).ok();
}

Status GpioValve::write(Time, bool open) {
  if (known_ && open == open_) return {};
  const Status set = line_->set(open != active_low_);
  known_ = set.ok();
  open_ = open;
  if (!set) return Error{ErrorCode::kUnavailable, "valve: " + set.error().message};
  return {};
}

}  // namespace furrow::actuation
