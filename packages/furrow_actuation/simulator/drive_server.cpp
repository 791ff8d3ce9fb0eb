#include "drive_server.hpp"

#include <arpa/inet.h>
#include <modbus.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <vector>

#include "furrow_core/error.hpp"

namespace furrow::actuation::drive_simulator {
namespace {

constexpr int kPollMs = 5;
constexpr std::size_t kUnitByte = 6;
constexpr std::size_t kDataByte = 19;

/// Answers one telegram of the manual's layout, byte by byte.
std::vector<std::uint8_t> answer(SimulatedDrive& drive, const std::vector<std::uint8_t>& request) {
  std::vector<std::uint8_t> reply(request.begin(), request.begin() + kUnitByte + 1);
  const auto finish = [&] {
    const std::size_t length = reply.size() - kUnitByte;
    reply[4] = static_cast<std::uint8_t>(length >> 8);
    reply[5] = static_cast<std::uint8_t>(length & 0xFF);
    return reply;
  };
  const auto refuse = [&](std::uint8_t code) {
    reply.push_back(static_cast<std::uint8_t>(request[7] | 0x80));
    reply.push_back(code);
    return finish();
  };
  if (request[7] != 43 || request.size() < 9 || request[8] != 13) return refuse(1);
  if (request.size() < kDataByte || request[18] < 1 || request[18] > 4) return refuse(3);
  const bool write = request[9] == 1;
  const int count = request[18];
  if (request.size() != kDataByte + static_cast<std::size_t>(write ? count : 0)) return refuse(3);
  const auto index = static_cast<std::uint16_t>(request[12] * 256 + request[13]);
  const std::uint8_t sub = request[14];
  reply.assign(request.begin(), request.begin() + kDataByte);
  if (write) {
    std::int64_t value = 0;
    std::int64_t scale = 1;
    for (int i = 0; i < count; ++i, scale *= 256) {
      value += scale * request[kDataByte + static_cast<std::size_t>(i)];
    }
    if (value >= scale / 2) value -= scale;  // two's complement
    const auto outcome = drive.write(index, sub, static_cast<std::int32_t>(value));
    if (outcome != SimulatedDrive::Answer::kOk) {
      reply.resize(kUnitByte + 1);
      return refuse(outcome == SimulatedDrive::Answer::kBadValue ? 3 : 2);
    }
    reply[18] = 0;
    return finish();
  }
  const auto value = drive.read(index, sub);
  if (!value) {
    reply.resize(kUnitByte + 1);
    return refuse(2);
  }
  for (int i = 0; i < count; ++i) {
    reply.push_back(static_cast<std::uint8_t>(static_cast<std::uint32_t>(*value) >> (8 * i)));
  }
  return finish();
}

bool readable(int socket) {
  pollfd waiting{socket, POLLIN, 0};
  return poll(&waiting, 1, kPollMs) > 0;
}

}  // namespace

struct DriveServer::Listener {
  modbus_t* context = nullptr;
  int socket = -1;
  ~Listener() {
    if (socket >= 0) ::close(socket);
    if (context != nullptr) {
      modbus_close(context);
      modbus_free(context);
    }
  }
};

DriveServer::DriveServer(SimulatedDrive& drive, const std::string& address, int port)
    : drive_(drive), listener_(std::make_unique<Listener>()) {
  listener_->context = modbus_new_tcp(address.c_str(), port);
  if (listener_->context != nullptr) listener_->socket = modbus_tcp_listen(listener_->context, 1);
  sockaddr_in bound{};
  socklen_t size = sizeof(bound);
  if (listener_->socket < 0 ||
      getsockname(listener_->socket, reinterpret_cast<sockaddr*>(&bound), &size) != 0) {
    throw ConfigError("drive simulator: cannot listen on " + address + ":" + std::to_string(port));
  }
  port_ = ntohs(bound.sin_port);
}

DriveServer::~DriveServer() = default;

void DriveServer::stop() {
  stopping_ = true;
}

void DriveServer::serve(const std::function<bool()>& before_request,
                        const std::function<void()>& idle) {
  while (!stopping_) {
    if (!readable(listener_->socket)) {
      if (idle) idle();
      continue;
    }
    if (modbus_tcp_accept(listener_->context, &listener_->socket) < 0) continue;
    while (!stopping_ && serve_one(before_request, idle)) {
    }
    modbus_close(listener_->context);
  }
}

bool DriveServer::serve_one(const std::function<bool()>& before_request,
                            const std::function<void()>& idle) {
  const int socket = modbus_get_socket(listener_->context);
  if (!readable(socket)) {
    if (idle) idle();
    return true;
  }
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> buffer{};
  const int head = modbus_receive(listener_->context, buffer.data());
  constexpr int kMbapBytes = 6;
  if (head <= kMbapBytes) return false;
  const int total = kMbapBytes + buffer[4] * 256 + buffer[5];
  if (total > static_cast<int>(buffer.size())) return false;
  int filled = head;
  while (filled < total && readable(socket)) {
    const auto got =
        recv(socket, buffer.data() + filled, static_cast<std::size_t>(total - filled), 0);
    if (got <= 0) return false;
    filled += static_cast<int>(got);
  }
  if (filled != total || !before_request()) return false;
  drive_.contact();
  const auto reply = answer(drive_, {buffer.begin(), buffer.begin() + total});
  return send(socket, reply.data(), reply.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(reply.size());
}

}  // namespace furrow::actuation::drive_simulator
