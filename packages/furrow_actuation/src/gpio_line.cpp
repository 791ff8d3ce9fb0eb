#include <gpiod.h>

#include <cerrno>
#include <cstring>

#include "furrow_actuation/gpio_valve.hpp"
#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

class LibgpiodLine final : public GpioLine {
 public:
  LibgpiodLine(const GpioValveParameters& parameters, bool initial_high)
      : chip_(gpiod_chip_open_lookup(parameters.chip.c_str())) {
    const std::string name = parameters.chip + " line " + std::to_string(parameters.line);
    if (!chip_) {
      throw ConfigError("GPIO: no chip '" + parameters.chip + "': " + std::strerror(errno));
    }
    line_ = gpiod_chip_get_line(chip_.get(), static_cast<unsigned>(parameters.line));
    if (line_ == nullptr) throw ConfigError("GPIO: no " + name + ": " + std::strerror(errno));
    if (gpiod_line_request_output(line_, "furrow valve", initial_high ? 1 : 0) != 0) {
      throw ConfigError("GPIO: " + name + " is not to be had: " + std::strerror(errno));
    }
  }

  Status set(bool high) override {
    if (gpiod_line_set_value(line_, high ? 1 : 0) == 0) return {};
    return Error{ErrorCode::kIo,
                 std::string("the GPIO line cannot be set: ") + std::strerror(errno)};
  }

 private:
  struct Close {
    void operator()(gpiod_chip* chip) const { gpiod_chip_close(chip); }
  };
  std::unique_ptr<gpiod_chip, Close> chip_;
  gpiod_line* line_ = nullptr;  // of the chip
};

}  // namespace

std::unique_ptr<GpioLine> open_gpio_line(const GpioValveParameters& parameters, bool initial_high) {
  return std::make_unique<LibgpiodLine>(parameters, initial_high);
}

}  // namespace furrow::actuation
