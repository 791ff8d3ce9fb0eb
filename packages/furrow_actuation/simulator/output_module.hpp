#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace furrow::actuation::drive_simulator {

/// A simulated Modbus TCP output module with eight coils, by libmodbus' own server, in real time
/// and on a dedicated thread. Its watchdog is that of WAGO's 750 couplers in the alternative
/// operation: time in register 1000h (units of 100 ms), started by 1 in 100Ah, fed by each request,
/// state in 1006h (0 off, 1 runs, 2 expired). When it expires all coils go off until the next
/// request.
class OutputModule {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t kCoils = 8;

  /// Listens on `port` (0: any free one). Throws ConfigError when it cannot.
  explicit OutputModule(const std::string& address = "127.0.0.1", int port = 0);
  ~OutputModule();
  OutputModule(const OutputModule&) = delete;
  OutputModule& operator=(const OutputModule&) = delete;

  [[nodiscard]] int port() const { return port_; }
  [[nodiscard]] bool coil(std::size_t index) const { return coils_[index]; }
  /// Writes of coils that were received, answered or not.
  [[nodiscard]] int writes() const { return writes_; }
  [[nodiscard]] int connections() const { return connections_; }
  [[nodiscard]] bool watchdog_expired() const { return watchdog_expired_; }

  /// Hangs up at the next request, before it acts on it.
  void hang_up() { hang_up_ = true; }
  /// Acts on the next request, but its answer is lost.
  void lose_reply() { lose_reply_ = true; }
  /// Answers come this much late, from the next request on.
  void set_delay(std::chrono::milliseconds delay) { delay_ms_ = static_cast<int>(delay.count()); }
  /// Called with each change of a coil, on the module's thread.
  void on_coil(std::function<void(std::size_t, bool, Clock::time_point)> told);
  void on_watchdog(std::function<void(Clock::time_point)> told);

 private:
  void serve();
  void serve_connection();
  bool serve_request();
  void set_coil(std::size_t index, bool level);
  void feed_watchdog();
  void check_watchdog();

  void* context_;  // modbus_t; the header stays free of libmodbus
  void* mapping_;  // modbus_mapping_t
  int socket_ = -1;
  int port_ = 0;
  std::array<std::atomic<bool>, kCoils> coils_{};
  std::atomic<int> writes_ = 0;
  std::atomic<int> connections_ = 0;
  std::atomic<bool> watchdog_expired_ = false;
  std::atomic<bool> hang_up_ = false;
  std::atomic<bool> lose_reply_ = false;
  std::atomic<int> delay_ms_ = 0;
  std::atomic<bool> stopping_ = false;
  Clock::time_point fed_;
  std::mutex mutex_;
  std::function<void(std::size_t, bool, Clock::time_point)> coil_told_;  // under mutex_
  std::function<void(Clock::time_point)> watchdog_told_;                 // under mutex_
  std::thread thread_;
};

}  // namespace furrow::actuation::drive_simulator
