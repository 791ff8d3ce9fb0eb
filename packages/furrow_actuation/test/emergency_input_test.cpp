#include "furrow_actuation/emergency_input.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

/// A pin whose level the test sets; without one it cannot be read.
class FakeInput final : public GpioInput {
 public:
  explicit FakeInput(const std::optional<bool>& level) : level_(level) {}
  Result<bool> high() override {
    if (level_) return *level_;
    return Error{ErrorCode::kIo, "no such device"};
  }

 private:
  const std::optional<bool>& level_;
};

TEST(EmergencyInput, IsPressedUnlessTheLineSaysReleased) {
  for (const bool released_high : {true, false}) {
    std::optional<bool> level = released_high;
    EmergencyInput input(std::make_unique<FakeInput>(level), released_high);
    EXPECT_FALSE(input.pressed());
    level = !released_high;
    EXPECT_TRUE(input.pressed());
    level = std::nullopt;
    EXPECT_TRUE(input.pressed());
    level = released_high;
    EXPECT_FALSE(input.pressed());
  }
}

TEST(EmergencyInput, AChipThatIsNotThereIsAConfigurationError) {
  EXPECT_THROW((void)open_gpio_input({.chip = "no_such_chip"}), ConfigError);
}

}  // namespace
}  // namespace furrow::actuation
