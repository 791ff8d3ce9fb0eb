#include "gateway_connection.hpp"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace furrow::actuation::cia402 {

Result<std::unique_ptr<GatewayConnection>> GatewayConnection::open(const std::string& address,
                                                                   int port, std::uint8_t unit,
                                                                   const CallBudget& budget) {
  modbus_t* context = modbus_new_tcp(address.c_str(), port);
  if (context == nullptr) {
    return Error{ErrorCode::kUnavailable, "the drive's address is not usable"};
  }
  std::unique_ptr<GatewayConnection> connection(new GatewayConnection(context, unit));
  connection->set_timeout(budget);
  if (modbus_connect(context) != 0) {
    return Error{ErrorCode::kUnavailable, "no connection to the drive"};
  }
  return connection;
}

GatewayConnection::~GatewayConnection() {
  modbus_close(context_);
  modbus_free(context_);
}

void GatewayConnection::set_timeout(const CallBudget& budget) {
  constexpr double kShortest_s = 2e-4;  // libmodbus refuses 0
  const auto us = static_cast<std::uint32_t>(std::max(kShortest_s, budget.left_s()) * 1e6);
  modbus_set_response_timeout(context_, us / 1000000, us % 1000000);
}

Result<std::int32_t> GatewayConnection::exchange(const Telegram& request, const Object& object,
                                                 bool write, const CallBudget& budget) {
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> answer{};
  Telegram addressed = request;
  addressed[0] = unit_;
  set_timeout(budget);
  if (modbus_send_raw_request(context_, addressed.begin(), static_cast<int>(addressed.size())) <
      0) {
    return Error{ErrorCode::kIo, "the drive does not take requests"};
  }
  // libmodbus does not know the function's length: it reads up to the MEI type, the rest is ours.
  const int head = modbus_receive_confirmation(context_, answer.data());
  constexpr int kMbapBytes = 6;
  const int total = head < kMbapBytes ? 0 : kMbapBytes + (answer[4] << 8 | answer[5]);
  int filled = head;
  while (filled > 0 && filled < total && total <= static_cast<int>(answer.size())) {
    pollfd waiting{modbus_get_socket(context_), POLLIN, 0};
    if (poll(&waiting, 1, static_cast<int>(std::ceil(budget.left_s() * 1e3))) <= 0) break;
    const auto got =
        recv(waiting.fd, answer.data() + filled, static_cast<std::size_t>(total - filled), 0);
    if (got <= 0) break;
    filled += static_cast<int>(got);
  }
  if (head <= 0 || filled != total) {
    return Error{ErrorCode::kIo, "the drive does not answer"};
  }
  const std::span<const std::uint8_t> telegram(answer.data() + kMbapBytes,
                                               static_cast<std::size_t>(total - kMbapBytes));
  return parse_response(telegram, object, write);
}

}  // namespace furrow::actuation::cia402
