// A simulated CiA 402 drive behind a Modbus TCP gateway, in real time:
//   cia402_drive_simulator [--profile-only] [PORT [ADDRESS]]      (1502, 127.0.0.1)
// --profile-only: it offers no cyclic positions.

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
    auto last = Clock::now();
    server.serve([&] {
      const auto now = Clock::now();
      constexpr double kLongest_s = 1.0;
      drive.advance(std::min(kLongest_s, std::chrono::duration<double>(now - last).count()));
      last = now;
      return true;
    });
    serving = nullptr;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
