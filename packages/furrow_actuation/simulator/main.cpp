// A simulated CiA 402 drive behind a Modbus TCP gateway, in real time:
//   cia402_drive_simulator [--profile-only] [PORT [ADDRESS]]      (1502, 127.0.0.1)
// --profile-only: it offers no cyclic positions.
// Prints each change of its state with the Unix time, as "1732994423.123456 quick_stop".

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <string_view>

#include "drive_server.hpp"

namespace {
std::atomic<furrow::actuation::drive_simulator::DriveServer*> serving = nullptr;

const char* name(furrow::actuation::drive_simulator::SimulatedDrive::Phase phase) {
  using enum furrow::actuation::drive_simulator::SimulatedDrive::Phase;
  switch (phase) {
    case kStarting:
      return "not_ready_to_switch_on";
    case kLocked:
      return "switch_on_disabled";
    case kPrepared:
      return "ready_to_switch_on";
    case kPoweredOn:
      return "switched_on";
    case kOperating:
      return "operation_enabled";
    case kQuickStop:
      return "quick_stop_active";
    case kReacting:
      return "fault_reaction_active";
    case kFaulted:
      return "fault";
  }
  return "unknown";
}

void stop_serving(int) {
  if (auto* server = serving.load()) server->stop();
}
}  // namespace

int main(int argc, char** argv) {
  const bool profile_only = argc > 1 && std::string_view(argv[1]) == "--profile-only";
  if (profile_only) --argc, ++argv;
  const std::string port_text = argc > 1 ? argv[1] : "1502";
  const std::string address = argc > 2 ? argv[2] : "127.0.0.1";
  char* end = nullptr;
  const long port = std::strtol(port_text.c_str(), &end, 10);
  if (argc > 3 || *end != '\0' || port < 0 || port > 65535) {
    std::fprintf(stderr, "usage: cia402_drive_simulator [--profile-only] [PORT [ADDRESS]]\n");
    return 2;
  }
  try {
    using Clock = std::chrono::steady_clock;
    furrow::actuation::drive_simulator::SimulatedDrive drive;
    drive.set_cyclic_offered(!profile_only);
    furrow::actuation::drive_simulator::DriveServer server(drive, address, static_cast<int>(port));
    serving = &server;
    std::signal(SIGINT, stop_serving);
    std::signal(SIGTERM, stop_serving);
    std::printf("simulated drive listening on %s:%d\n", address.c_str(), server.port());
    std::fflush(stdout);
    drive.on_phase([](auto phase) {
      const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
      std::printf("%.6f %s\n", now.count(), name(phase));
      std::fflush(stdout);
    });
    auto last = Clock::now();
    const auto pass_time = [&] {
      const auto now = Clock::now();
      constexpr double kLongest_s = 1.0;
      drive.advance(std::min(kLongest_s, std::chrono::duration<double>(now - last).count()));
      last = now;
      return true;
    };
    server.serve(pass_time, [&] { pass_time(); });
    serving = nullptr;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
