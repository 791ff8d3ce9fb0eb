#pragma once

#include <modbus.h>

#include <memory>
#include <string>

#include "furrow_actuation/call_budget.hpp"
#include "furrow_actuation/canopen_gateway.hpp"

namespace furrow::actuation::cia402 {

/// One TCP connection to a CANopen gateway. After a failed exchange it is of no more use.
class GatewayConnection {
 public:
  /// kUnavailable: the address is not usable, or nothing answers within the budget.
  [[nodiscard]] static Result<std::unique_ptr<GatewayConnection>> open(const std::string& address,
                                                                       int port, std::uint8_t unit,
                                                                       const CallBudget& budget);
  ~GatewayConnection();
  GatewayConnection(const GatewayConnection&) = delete;
  GatewayConnection& operator=(const GatewayConnection&) = delete;

  /// The value of an object, or 0 for a write. kUnavailable: the drive refused, the connection
  /// holds. With kIo (no answer in time) and kParse (an answer to something else) it is lost.
  [[nodiscard]] Result<std::int32_t> exchange(const Telegram& request, const Object& object,
                                              bool write, const CallBudget& budget);

 private:
  GatewayConnection(modbus_t* context, std::uint8_t unit) : context_(context), unit_(unit) {}
  void set_timeout(const CallBudget& budget);

  modbus_t* context_;
  std::uint8_t unit_;
};

}  // namespace furrow::actuation::cia402
