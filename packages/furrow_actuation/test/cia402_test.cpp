#include "furrow_actuation/cia402.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "furrow_actuation/canopen_gateway.hpp"
#include "furrow_core/random.hpp"

namespace furrow::actuation::cia402 {
namespace {

TEST(Statusword, DecodesThePatternsOfTheStandard) {
  // Bits 6, 5, 3, 2, 1, 0; x does not matter.
  const std::map<std::string, State> patterns{
      {"0x0000", State::kNotReadyToSwitchOn},  {"1x0000", State::kSwitchOnDisabled},
      {"010001", State::kReadyToSwitchOn},     {"010011", State::kSwitchedOn},
      {"010111", State::kOperationEnabled},    {"000111", State::kQuickStopActive},
      {"0x1111", State::kFaultReactionActive}, {"0x1000", State::kFault}};
  constexpr int kBits[] = {6, 5, 3, 2, 1, 0};
  for (int word = 0; word <= 0xFFFF; ++word) {
    std::optional<State> expected;
    for (const auto& [pattern, state] : patterns) {
      bool match = true;
      for (std::size_t i = 0; i < 6; ++i) {
        const bool set = (word >> kBits[i] & 1) != 0;
        match = match && (pattern[i] == 'x' || (pattern[i] == '1') == set);
      }
      if (match) expected = state;
    }
    ASSERT_EQ(decode_state(static_cast<std::uint16_t>(word)), expected) << word;
  }
}

TEST(Sequencer, EnablesStepByStepFromEveryState) {
  const auto word_for = [](Goal goal, std::uint16_t status) {
    Sequencer s;
    s.set_goal(goal);
    return s.next(status);
  };
  EXPECT_EQ(word_for(Goal::kOperate, 0x0240), command::kShutdown);
  EXPECT_EQ(word_for(Goal::kOperate, 0x0231), command::kSwitchOn);
  EXPECT_EQ(word_for(Goal::kOperate, 0x0233), command::kEnableOperation);
  EXPECT_EQ(word_for(Goal::kOperate, 0x0237), command::kEnableOperation);
  EXPECT_EQ(word_for(Goal::kOperate, 0x0217), command::kDisableVoltage);
  EXPECT_EQ(word_for(Goal::kOperate, 0x0218), command::kDisableVoltage);  // in fault: no reset
  for (const int status : {0x0240, 0x0231, 0x0233, 0x0237, 0x0217, 0x0218}) {
    EXPECT_EQ(word_for(Goal::kPowerOff, static_cast<std::uint16_t>(status)),
              command::kDisableVoltage);
  }
  EXPECT_EQ(word_for(Goal::kQuickStop, 0x0237), command::kQuickStop);
  EXPECT_EQ(word_for(Goal::kQuickStop, 0x0217), command::kQuickStop);
  EXPECT_EQ(word_for(Goal::kQuickStop, 0x0233), command::kDisableVoltage);
}

TEST(Sequencer, ResetsFaultsByARisingEdgeOnly) {
  Sequencer s;
  s.set_goal(Goal::kResetFault);
  EXPECT_EQ(s.next(0x0208), command::kFaultReset);
  EXPECT_EQ(s.next(0x0208), command::kDisableVoltage);
  EXPECT_EQ(s.next(0x0208), command::kFaultReset);
  EXPECT_EQ(s.next(0x0240), command::kDisableVoltage);
  EXPECT_TRUE(s.reached(0x0240));
  EXPECT_FALSE(s.reached(0x0208));
}

TEST(Sequencer, WaitsWhereTheDriveMovesOnByItself) {
  Sequencer s;
  s.set_goal(Goal::kOperate);
  EXPECT_EQ(s.next(0x0233), command::kEnableOperation);
  EXPECT_EQ(s.next(0x021F), command::kEnableOperation);  // fault reaction
  EXPECT_EQ(s.next(0x0200), command::kEnableOperation);  // not ready
  EXPECT_EQ(s.next(0x026F), command::kEnableOperation);  // no meaning
}

std::span<const std::uint8_t> bytes(const Telegram& t) {
  return {t.begin(), t.size()};
}

TEST(Gateway, LaysOutTelegramsAsTheManualDoes) {
  const Telegram read = read_request({0x6041, 0, 2});
  const std::vector<std::uint8_t> expected{0, 43, 13, 0, 0, 0, 96, 65, 0, 0, 0, 0, 2};
  EXPECT_EQ(std::vector<std::uint8_t>(read.begin(), read.end()), expected);
  const Telegram write = write_request({0x6040, 0, 2}, command::kEnableOperation);
  const std::vector<std::uint8_t> enable{0, 43, 13, 1, 0, 0, 96, 64, 0, 0, 0, 0, 2, 15, 0};
  EXPECT_EQ(std::vector<std::uint8_t>(write.begin(), write.end()), enable);
}

TEST(Gateway, ValuesSurviveTheWayThereAndBack) {
  Random random(1, "gateway");
  for (int i = 0; i < 5000; ++i) {
    const auto size = static_cast<std::uint8_t>(random.integer(1, 4));
    const std::int64_t half = std::int64_t{1} << (8 * size - 1);
    const auto value = static_cast<std::int32_t>(random.integer(-half, half - 1));
    const Object object{static_cast<std::uint16_t>(random.integer(0, 0xFFFF)),
                        static_cast<std::uint8_t>(random.integer(0, 255)), size};
    const auto request = parse_request(bytes(write_request(object, value)));
    ASSERT_TRUE(request.ok());
    ASSERT_EQ(request->value, value);
    ASSERT_EQ(request->object.index, object.index);
    const auto answer = parse_response(bytes(read_response(object, value)), object, false);
    ASSERT_TRUE(answer.ok());
    ASSERT_EQ(*answer, value);
    ASSERT_TRUE(parse_response(bytes(write_response(object)), object, true).ok());
  }
}

TEST(Gateway, RefusesWhatIsNotSuchATelegram) {
  const Object object{0x6041, 0, 2};
  const Telegram good = read_response(object, 0x0237);
  for (std::size_t n = 0; n < good.size(); ++n) {
    EXPECT_FALSE(parse_response({good.begin(), n}, object, false).ok()) << n;
  }
  EXPECT_EQ(parse_response(bytes(good), {0x6064, 0, 2}, false).error().code, ErrorCode::kParse);
  EXPECT_EQ(parse_response(bytes(good), {0x6041, 0, 4}, false).error().code, ErrorCode::kParse);
  EXPECT_EQ(parse_response(bytes(good), object, true).error().code, ErrorCode::kParse);
  EXPECT_EQ(parse_response(bytes(exception_response(2)), object, false).error().code,
            ErrorCode::kUnavailable);
  Random random(2, "gateway");
  for (int i = 0; i < 20000; ++i) {
    std::vector<std::uint8_t> noise(static_cast<std::size_t>(random.integer(0, 20)));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.integer(0, 255));
    if (noise.size() > 3 && random.bernoulli(0.7)) {
      noise[1] = kFunction;
      noise[2] = kMeiType;
      noise[3] = static_cast<std::uint8_t>(random.integer(0, 1));
    }
    const auto request = parse_request(noise);
    if (request.ok()) {
      const Telegram again = request->write ? write_request(request->object, request->value)
                                            : read_request(request->object);
      ASSERT_EQ(again.size(), noise.size());
    }
    (void)parse_response(noise, object, false).ok();
  }
}

}  // namespace
}  // namespace furrow::actuation::cia402
