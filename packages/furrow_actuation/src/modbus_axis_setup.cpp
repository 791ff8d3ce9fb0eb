// How a drive is configured at each connection, and what of it is confirmed.

#include <array>
#include <cmath>

#include "cia402_objects.hpp"
#include "furrow_actuation/modbus_axis_driver.hpp"
#include "gateway_connection.hpp"

namespace furrow::actuation::cia402 {

using namespace objects;

Status ModbusAxisDriver::connect() {
  start_budget(kConnectTimeouts);
  auto opened = GatewayConnection::open(parameters_.address, static_cast<int>(parameters_.port),
                                        static_cast<std::uint8_t>(parameters_.unit), *budget_);
  if (!opened) {
    lose_connection();
    return opened.error();
  }
  connection_ = std::move(*opened);
  mode_ = 0;
  controlword_ = 0;
  if (Status status = configure(); !status) {
    lose_connection();
    return status;
  }
  return {};
}

Status ModbusAxisDriver::configure() {
  const std::array<std::pair<Object, std::int32_t>, 5> settings{
      {{kLowerLimit, counts(limits_.lower_m)},
       {kUpperLimit, counts(limits_.upper_m)},
       {kProfileVelocity, counts(limits_.max_velocity_mps)},
       {kProfileAcceleration, counts(limits_.max_acceleration_mps2)},
       {kProfileDeceleration, counts(limits_.max_acceleration_mps2)}}};
  for (const auto& [object, value] : settings) {
    if (Status status = set(object, value); !status) return status;
  }
  if (Status status = configure_protection(); !status) return status;
  const auto modes = get(kSupportedModes);
  if (!modes && lost_) return modes.error();
  constexpr int kCyclicPositionBit = 7;
  cyclic_offered_ = modes.ok() && (*modes >> kCyclicPositionBit & 1) != 0;
  return {};
}

Status ModbusAxisDriver::configure_protection() {
  unconfirmed_.clear();
  Status status = protect(kQuickStopDeceleration, counts(limits_.max_acceleration_mps2),
                          "quick stop deceleration (6085h)");
  if (status.ok()) {
    status = protect(kQuickStopOption, kQuickStopRampThenPowerOff, "quick stop option (605Ah)");
  }
  if (status.ok()) {
    status = protect(kFaultReactionOption, kFaultQuickStopRamp, "fault reaction (605Eh)");
  }
  if (status.ok()) {
    status = protect(kAbortOption, kAbortQuickStop, "reaction to a lost connection (6007h)");
  }
  if (parameters_.watchdog_index == 0) {
    unconfirmed_ += (unconfirmed_.empty() ? "drive: " : ", ");
    unconfirmed_ += "connection watchdog (watchdog_index is 0)";
  } else if (status.ok()) {
    const Object watchdog{static_cast<std::uint16_t>(parameters_.watchdog_index),
                          static_cast<std::uint8_t>(parameters_.watchdog_sub_index),
                          static_cast<std::uint8_t>(parameters_.watchdog_bytes)};
    const double units = parameters_.watchdog_s / parameters_.watchdog_unit_s;
    status =
        protect(watchdog, static_cast<std::int32_t>(std::lround(units)), "connection watchdog");
  }
  return status;
}

/// Fails only when the connection is lost; what the drive refuses or does not keep is noted.
Status ModbusAxisDriver::protect(const Object& object, std::int32_t value, std::string_view what) {
  const Status written = set(object, value);
  if (!written && lost_) return written;
  const auto kept = get(object);
  if (!kept && lost_) return kept.error();
  if (written.ok() && kept.ok() && *kept == value) return {};
  unconfirmed_ += (unconfirmed_.empty() ? "drive: " : ", ");
  unconfirmed_ += what;
  return {};
}

}  // namespace furrow::actuation::cia402
