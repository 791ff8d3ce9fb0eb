#include <gpiod.h>

#include <cerrno>
#include <cstring>

#include "furrow_actuation/emergency_input.hpp"
#include "furrow_actuation/gpio_valve.hpp"
#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

constexpr char kValve[] = "furrow valve";
constexpr char kEmergencyStop[] = "furrow emergency stop";

/// A line and the chip that it belongs to.
class LibgpiodLine {
 public:
  LibgpiodLine(const std::string& chip, std::int64_t line)
      : name_(chip + " line " + std::to_string(line)), chip_(gpiod_chip_open_lookup(chip.c_str())) {
    if (!chip_) throw ConfigError("GPIO: no chip '" + chip + "': " + std::strerror(errno));
    line_ = gpiod_chip_get_line(chip_.get(), static_cast<unsigned>(line));
    if (line_ == nullptr) throw ConfigError("GPIO: no " + name_ + ": " + std::strerror(errno));
  }

  [[nodiscard]] gpiod_line* get() const { return line_; }
  void require(int requested) const {
    if (requested == 0) return;
    throw ConfigError("GPIO: " + name_ + " cannot be requested: " + std::strerror(errno));
  }

 private:
  struct Close {
    void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }
  };
  std::string name_;
  std::unique_ptr<gpiod_chip, Close> chip_;
  gpiod_line* line_ = nullptr;  // of the chip
};

class LibgpiodOutput final : public GpioLine {
 public:
  LibgpiodOutput(const GpioValveParameters& parameters, bool initial_high)
      : line_(parameters.chip, parameters.line) {
    line_.require(gpiod_line_request_output(line_.get(), kValve, initial_high ? 1 : 0));
  }

  Status set(bool high) override {
    if (gpiod_line_set_value(line_.get(), high ? 1 : 0) == 0) return {};
    return Error{ErrorCode::kIo,
                 std::string("the GPIO line cannot be set: ") + std::strerror(errno)};
  }

 private:
  LibgpiodLine line_;
};

class LibgpiodInput final : public GpioInput {
 public:
  explicit LibgpiodInput(const EmergencyInputParameters& parameters)
      : line_(parameters.chip, parameters.line) {
    line_.require(gpiod_line_request_input(line_.get(), kEmergencyStop));
  }

  Result<bool> high() override {
    const int level = gpiod_line_get_value(line_.get());
    if (level >= 0) return level == 1;
    return Error{ErrorCode::kIo,
                 std::string("the GPIO line cannot be read: ") + std::strerror(errno)};
  }

 private:
  LibgpiodLine line_;
};

}  // namespace

std::unique_ptr<GpioLine> open_gpio_line(const GpioValveParameters& parameters, bool initial_high) {
  return std::make_unique<LibgpiodOutput>(parameters, initial_high);
}

std::unique_ptr<GpioInput> open_gpio_input(const EmergencyInputParameters& parameters) {
  return std::make_unique<LibgpiodInput>(parameters);
}

}  // namespace furrow::actuation
