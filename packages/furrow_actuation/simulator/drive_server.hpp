#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "simulated_drive.hpp"

namespace furrow::actuation::drive_simulator {

/// Serves one simulated drive by libmodbus as a Modbus TCP gateway, one connection at a time.
class DriveServer {
 public:
  /// Listens on `port` (0: any free one). Throws ConfigError when it cannot.
  DriveServer(SimulatedDrive& drive, const std::string& address, int port);
  ~DriveServer();
  DriveServer(const DriveServer&) = delete;
  DriveServer& operator=(const DriveServer&) = delete;

  [[nodiscard]] int port() const { return port_; }
  /// Serves until stop(). `before_request` is called in the serving thread before each request is
  /// answered: there time moves. False cuts the connection instead of answering. `idle` is called
  /// every few milliseconds while nothing is received.
  void serve(const std::function<bool()>& before_request, const std::function<void()>& idle = {});
  /// May be called from another thread.
  void stop();

 private:
  struct Listener;
  bool serve_one(const std::function<bool()>& before_request, const std::function<void()>& idle);

  SimulatedDrive& drive_;
  std::unique_ptr<Listener> listener_;
  int port_ = 0;
  std::atomic<bool> stopping_ = false;
};

}  // namespace furrow::actuation::drive_simulator
