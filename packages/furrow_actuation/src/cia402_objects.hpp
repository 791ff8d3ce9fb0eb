#pragma once

#include "furrow_actuation/canopen_gateway.hpp"

namespace furrow::actuation::cia402::objects {

inline constexpr Object kAbortOption{0x6007, 0, 2};
inline constexpr Object kControlword{0x6040, 0, 2};
inline constexpr Object kStatusword{0x6041, 0, 2};
inline constexpr Object kQuickStopOption{0x605A, 0, 2};
inline constexpr Object kFaultReactionOption{0x605E, 0, 2};
inline constexpr Object kModeOfOperation{0x6060, 0, 1};
inline constexpr Object kPosition{0x6064, 0, 4};
inline constexpr Object kVelocity{0x606C, 0, 4};
inline constexpr Object kTargetPosition{0x607A, 0, 4};
inline constexpr Object kLowerLimit{0x607D, 1, 4};
inline constexpr Object kUpperLimit{0x607D, 2, 4};
inline constexpr Object kProfileVelocity{0x6081, 0, 4};
inline constexpr Object kProfileAcceleration{0x6083, 0, 4};
inline constexpr Object kProfileDeceleration{0x6084, 0, 4};
inline constexpr Object kQuickStopDeceleration{0x6085, 0, 4};
inline constexpr Object kHomingMethod{0x6098, 0, 1};
inline constexpr Object kHomingSearchSpeed{0x6099, 1, 4};
inline constexpr Object kHomingCreepSpeed{0x6099, 2, 4};
inline constexpr Object kHomingAcceleration{0x609A, 0, 4};
inline constexpr Object kFollowingErrorValue{0x60F4, 0, 4};
inline constexpr Object kSupportedModes{0x6502, 0, 4};

// Values of the option codes (CiA 402-2).
inline constexpr std::int32_t kQuickStopRampThenPowerOff = 2;  // 605Ah
inline constexpr std::int32_t kFaultQuickStopRamp = 2;         // 605Eh
inline constexpr std::int32_t kAbortQuickStop = 3;             // 6007h

}  // namespace furrow::actuation::cia402::objects
