#include "output_module.hpp"

#include <arpa/inet.h>
#include <modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <utility>

#include "furrow_core/error.hpp"

namespace furrow::actuation::drive_simulator {
namespace {

constexpr int kModulePollMs = 5;
constexpr int kFirstRegister = 0x1000;
constexpr int kTime = 0x1000;
constexpr int kState = 0x1006;
constexpr int kAlternative = 0x100A;
constexpr int kRegisters = 16;
constexpr std::uint8_t kWriteCoil = 5;
constexpr std::uint8_t kWriteRegister = 6;

modbus_t* modbus(void* context) {
  return static_cast<modbus_t*>(context);
}

modbus_mapping_t* mapping(void* m) {
  return static_cast<modbus_mapping_t*>(m);
}

std::uint16_t& reg(void* m, int address) {
  return mapping(m)->tab_registers[address - kFirstRegister];
}

bool request_waits(int socket) {
  pollfd waiting{socket, POLLIN, 0};
  return poll(&waiting, 1, kModulePollMs) > 0;
}

}  // namespace

OutputModule::OutputModule(const std::string& address, int port)
    : context_(modbus_new_tcp(address.c_str(), port)),
      mapping_(
          modbus_mapping_new_start_address(0, kCoils, 0, 0, kFirstRegister, kRegisters, 0, 0)) {
  if (context_ != nullptr) socket_ = modbus_tcp_listen(modbus(context_), 1);
  sockaddr_in bound{};
  socklen_t size = sizeof(bound);
  if (socket_ < 0 || mapping_ == nullptr ||
      getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &size) != 0) {
    throw ConfigError("output module simulator: cannot listen on " + address + ":" +
                      std::to_string(port));
  }
  port_ = ntohs(bound.sin_port);
  thread_ = std::thread([this] { serve(); });
}

OutputModule::~OutputModule() {
  stopping_ = true;
  thread_.join();
  close(socket_);
  modbus_mapping_free(mapping(mapping_));
  modbus_free(modbus(context_));
}

void OutputModule::on_coil(std::function<void(std::size_t, bool, Clock::time_point)> told) {
  const std::lock_guard lock(mutex_);
  coil_told_ = std::move(told);
}

void OutputModule::on_watchdog(std::function<void(Clock::time_point)> told) {
  const std::lock_guard lock(mutex_);
  watchdog_told_ = std::move(told);
}

void OutputModule::serve() {
  while (!stopping_) {
    if (!request_waits(socket_)) {
      check_watchdog();
    } else if (modbus_tcp_accept(modbus(context_), &socket_) >= 0) {
      ++connections_;
      serve_connection();
      modbus_close(modbus(context_));
    }
  }
}

// A new connection takes the place of one that is silent: the client may have opened it because
// the old one was lost.
void OutputModule::serve_connection() {
  while (!stopping_) {
    if (request_waits(modbus_get_socket(modbus(context_)))) {
      if (!serve_request()) return;
    } else {
      check_watchdog();
      pollfd waiting{socket_, POLLIN, 0};
      if (poll(&waiting, 1, 0) > 0) return;
    }
  }
}

bool OutputModule::serve_request() {
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> request{};
  const int size = modbus_receive(modbus(context_), request.data());
  if (size < 0 || hang_up_.exchange(false)) return false;
  if (size == 0) return true;
  feed_watchdog();
  const std::uint8_t function = request[7];
  const int address = request[8] * 256 + request[9];
  if (function == kWriteCoil && address < static_cast<int>(kCoils)) {
    ++writes_;
    set_coil(static_cast<std::size_t>(address), request[10] != 0);
  }
  if (function == kWriteRegister && address == kAlternative) reg(mapping_, kState) = 1;
  if (const int late_ms = delay_ms_; late_ms > 0) {
    std::this_thread::sleep_for(std::chrono::milliseconds(late_ms));
  }
  if (lose_reply_.exchange(false)) return true;
  modbus_reply(modbus(context_), request.data(), size, mapping(mapping_));
  return true;
}

void OutputModule::set_coil(std::size_t index, bool level) {
  if (coils_[index].exchange(level) == level) return;
  const std::lock_guard lock(mutex_);
  if (coil_told_) coil_told_(index, level, Clock::now());
}

void OutputModule::feed_watchdog() {
  fed_ = Clock::now();
  if (reg(mapping_, kState) == 2) reg(mapping_, kState) = 1;
}

void OutputModule::check_watchdog() {
  const auto now = Clock::now();
  const auto limit = std::chrono::milliseconds(100) * reg(mapping_, kTime);
  if (reg(mapping_, kState) != 1 || now - fed_ < limit) return;
  reg(mapping_, kState) = 2;
  watchdog_expired_ = true;
  for (std::size_t i = 0; i < kCoils; ++i) set_coil(i, false);
  const std::lock_guard lock(mutex_);
  if (watchdog_told_) watchdog_told_(now);
}

}  // namespace furrow::actuation::drive_simulator
