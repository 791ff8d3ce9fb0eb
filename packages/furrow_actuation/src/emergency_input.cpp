#include "furrow_actuation/emergency_input.hpp"

namespace furrow::actuation {

void EmergencyInputParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "chip", .description = "name or path of the GPIO chip"}, chip);
  v.visit({.name = "line", .description = "line of the chip, from 0", .min = 0, .max = 1023}, line);
  v.visit({.name = "released_high",
           .description = "a high level says that the emergency stop is released"},
          released_high);
}

bool EmergencyInput::pressed() {
  const Result<bool> high = input_->high();
  return !high.ok() || *high != released_high_;
}

}  // namespace furrow::actuation
