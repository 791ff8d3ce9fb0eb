#pragma once

#include <memory>
#include <string>

#include "furrow_core/parameters.hpp"
#include "furrow_core/result.hpp"

namespace furrow::actuation {

/// One digital input.
class GpioInput {
 public:
  virtual ~GpioInput() = default;
  /// The level at the pin. Fails with kIo.
  [[nodiscard]] virtual Result<bool> high() = 0;
};

struct EmergencyInputParameters {
  std::string chip = "gpiochip0";
  std::int64_t line = 0;
  bool released_high = true;

  void visit(ParameterVisitor& v);
};

/// A line of a GPIO chip of this computer by libgpiod, requested as an input. Throws ConfigError
/// when there is no such chip or line, or another process holds it.
[[nodiscard]] std::unique_ptr<GpioInput> open_gpio_input(
    const EmergencyInputParameters& parameters);

/// An emergency stop at a digital input, wired so that a broken wire reads as pressed.
class EmergencyInput {
 public:
  EmergencyInput(std::unique_ptr<GpioInput> input, bool released_high)
      : input_(std::move(input)), released_high_(released_high) {}

  /// Also true when the input cannot be read.
  [[nodiscard]] bool pressed();

 private:
  std::unique_ptr<GpioInput> input_;
  bool released_high_;
};

}  // namespace furrow::actuation
