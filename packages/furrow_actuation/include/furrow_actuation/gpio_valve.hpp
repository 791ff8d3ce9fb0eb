#pragma once

#include <memory>
#include <string>

#include "furrow_actuation/nozzle.hpp"

namespace furrow::actuation {

/// One digital output.
class GpioLine {
 public:
  virtual ~GpioLine() = default;
  /// Sets the level at the pin. Fails with kIo.
  virtual Status set(bool high) = 0;
};

struct GpioValveParameters {
  std::string chip = "gpiochip0";
  std::int64_t line = 0;
  bool active_low = false;

  void visit(ParameterVisitor& v);
};

/// A line of a GPIO chip of this computer by libgpiod, requested as an output at `initial_high`.
/// Throws ConfigError when there is no such chip or line, or another process holds it.
[[nodiscard]] std::unique_ptr<GpioLine> open_gpio_line(const GpioValveParameters& parameters,
                                                       bool initial_high);

/// A valve at a digital output, through a driver stage that shuts when the output floats.
class GpioValve final : public ValveDriver {
 public:
  /// Shuts the valve.
  GpioValve(std::unique_ptr<GpioLine> line, bool active_low);
  /// Shuts the valve.
  ~GpioValve() override;
  GpioValve(const GpioValve&) = delete;
  GpioValve& operator=(const GpioValve&) = delete;

  /// Sets the line when the level changes or the last setting failed. kUnavailable: it failed.
  Status write(Time time, bool open) override;

 private:
  std::unique_ptr<GpioLine> line_;
  bool active_low_;
  bool open_ = false;
  bool known_ = false;
};

}  // namespace furrow::actuation
