#include "furrow_actuation/gpio_valve.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

/// A line whose pin the test looks at.
struct Pin {
  std::vector<bool> levels;
  bool broken = false;
};

class FakeLine final : public GpioLine {
 public:
  explicit FakeLine(Pin& pin) : pin_(pin) {}
  Status set(bool high) override {
    if (pin_.broken) return Error{ErrorCode::kIo, "no such device"};
    pin_.levels.push_back(high);
    return {};
  }

 private:
  Pin& pin_;
};

TEST(GpioValve, IsShutFromTheStartFollowsItsLevelsAndIsShutAtTheEnd) {
  Pin pin;
  {
    GpioValve valve(std::make_unique<FakeLine>(pin), false);
    for (const bool open : {false, false, true, true, true, false, true}) {
      EXPECT_TRUE(valve.write(Time(), open).ok());
    }
  }
  EXPECT_EQ(pin.levels, (std::vector<bool>{false, true, false, true, false}));
}

TEST(GpioValve, ActiveLowTurnsTheLevelsRound) {
  Pin pin;
  {
    GpioValve valve(std::make_unique<FakeLine>(pin), true);
    EXPECT_TRUE(valve.write(Time(), true).ok());
  }
  EXPECT_EQ(pin.levels, (std::vector<bool>{true, false, true}));
}

TEST(GpioValve, AFailureIsToldAndTheLevelSetAgain) {
  Pin pin;
  GpioValve valve(std::make_unique<FakeLine>(pin), false);
  EXPECT_TRUE(valve.write(Time(), true).ok());
  pin.broken = true;
  const Status failed = valve.write(Time(), false);
  ASSERT_FALSE(failed.ok());
  EXPECT_EQ(failed.error().code, ErrorCode::kUnavailable);
  EXPECT_EQ(failed.error().message, "valve: no such device");
  EXPECT_FALSE(valve.write(Time(), false).ok());
  pin.broken = false;
  EXPECT_TRUE(valve.write(Time(), false).ok());
  EXPECT_EQ(pin.levels, (std::vector<bool>{false, true, false}));
}

TEST(GpioLine, AChipThatIsNotThereIsAConfigurationError) {
  try {
    (void)open_gpio_line({.chip = "no_such_chip"}, false);
    FAIL() << "a line of no chip";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("no_such_chip"), std::string::npos);
  }
}

}  // namespace
}  // namespace furrow::actuation
