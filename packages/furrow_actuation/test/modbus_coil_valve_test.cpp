#include "furrow_actuation/modbus_coil_valve.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <thread>

#include "furrow_core/error.hpp"

namespace furrow::actuation {
namespace {

/// An output module with eight coils on the loopback, by libmodbus's own server.
class OutputModule {
 public:
  OutputModule() {
    context_ = modbus_new_tcp("127.0.0.1", 0);
    socket_ = modbus_tcp_listen(context_, 1);
    sockaddr_in bound{};
    socklen_t size = sizeof(bound);
    getsockname(socket_, reinterpret_cast<sockaddr*>(&bound), &size);
    port_ = ntohs(bound.sin_port);
    mapping_ = modbus_mapping_new(8, 0, 0, 0);
    thread_ = std::thread([this] { serve(); });
  }
  ~OutputModule() {
    stopping_ = true;
    thread_.join();
    close(socket_);
    modbus_mapping_free(mapping_);
    modbus_free(context_);
  }
  OutputModule(const OutputModule&) = delete;
  OutputModule& operator=(const OutputModule&) = delete;

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] bool coil(int index) const { return coils_[static_cast<std::size_t>(index)]; }
  [[nodiscard]] int writes() const { return writes_; }
  /// Hangs up at the next request instead of answering.
  void hang_up() { hang_up_ = true; }

 private:
  static bool readable(int socket) {
    pollfd waiting{socket, POLLIN, 0};
    return poll(&waiting, 1, 10) > 0;
  }
  void serve() {
    while (!stopping_) {
      if (!readable(socket_) || modbus_tcp_accept(context_, &socket_) < 0) continue;
      while (!stopping_) {
        if (!readable(modbus_get_socket(context_))) continue;
        std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> request{};
        const int size = modbus_receive(context_, request.data());
        if (size < 0 || hang_up_.exchange(false)) break;
        if (size == 0) continue;
        // Counted before the answer, so that the writer who has it sees the effect.
        ++writes_;
        coils_[request[9]] = request[10] != 0;
        modbus_reply(context_, request.data(), size, mapping_);
      }
      modbus_close(context_);
    }
  }

  modbus_t* context_;
  modbus_mapping_t* mapping_;
  int socket_;
  int port_ = 0;
  std::array<std::atomic<bool>, 8> coils_{};
  std::atomic<int> writes_ = 0;
  std::atomic<bool> hang_up_ = false;
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

ModbusCoilParameters parameters(const OutputModule& module) {
  return {.port = module.port(), .coil = 3, .timeout_s = 1.0};
}

Time ms(std::int64_t milliseconds) {
  return Time() + Duration::milliseconds(milliseconds);
}

TEST(ModbusCoilValve, WritesItsCoilOnChangeAndToRefresh) {
  OutputModule module;
  {
    ModbusCoilValve valve(parameters(module));
    EXPECT_TRUE(valve.write(ms(0), false).ok());
    EXPECT_EQ(module.writes(), 1);
    EXPECT_TRUE(valve.write(ms(2), true).ok());
    EXPECT_TRUE(module.coil(3));
    EXPECT_TRUE(valve.write(ms(4), true).ok());
    EXPECT_EQ(module.writes(), 2);
    EXPECT_TRUE(valve.write(ms(104), true).ok());
    EXPECT_EQ(module.writes(), 3);
    for (int other : {0, 1, 2, 4, 5, 6, 7}) EXPECT_FALSE(module.coil(other));
  }
  EXPECT_FALSE(module.coil(3));  // shut when the driver goes
}

TEST(ModbusCoilValve, ALostModuleIsToldAndFoundAgain) {
  OutputModule module;
  ModbusCoilValve valve(parameters(module));
  EXPECT_TRUE(valve.write(ms(0), false).ok());
  module.hang_up();
  const Status lost = valve.write(ms(2), true);
  ASSERT_FALSE(lost.ok());
  EXPECT_EQ(lost.error().code, ErrorCode::kUnavailable);
  EXPECT_FALSE(valve.write(ms(4), false).ok());  // not before reconnect_s
  EXPECT_TRUE(valve.write(ms(600), false).ok());
  EXPECT_FALSE(module.coil(3));
}

TEST(ModbusCoilValve, NobodyThereIsUnavailable) {
  int port = 0;
  { port = OutputModule().port(); }
  ModbusCoilValve valve({.port = port});
  EXPECT_EQ(valve.write(ms(0), true).error().code, ErrorCode::kUnavailable);
}

TEST(ModbusCoilValve, AnAddressThatIsNoneIsAConfigurationError) {
  EXPECT_THROW(ModbusCoilValve({.address = "not an address"}), ConfigError);
}

}  // namespace
}  // namespace furrow::actuation
