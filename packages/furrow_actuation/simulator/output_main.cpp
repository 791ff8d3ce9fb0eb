// A simulated Modbus TCP output module with eight coils, in real time:
//   modbus_output_simulator [PORT [ADDRESS]]      (1503, 127.0.0.1)
// Prints each change of a coil and the end of its watchdog's time with the Unix time, as
// "1732994423.123456 coil 0 on".

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <thread>

#include "output_module.hpp"

namespace {

std::atomic<bool> stopping = false;

double unix_now() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string port_text = argc > 1 ? argv[1] : "1503";
  const std::string address = argc > 2 ? argv[2] : "127.0.0.1";
  char* end = nullptr;
  const long port = std::strtol(port_text.c_str(), &end, 10);
  if (argc > 3 || *end != '\0' || port < 0 || port > 65535) {
    std::fprintf(stderr, "usage: modbus_output_simulator [PORT [ADDRESS]]\n");
    return 2;
  }
  try {
    furrow::actuation::drive_simulator::OutputModule module(address, static_cast<int>(port));
    module.on_coil([](std::size_t coil, bool level, auto) {
      std::printf("%.6f coil %zu %s\n", unix_now(), coil, level ? "on" : "off");
      std::fflush(stdout);
    });
    module.on_watchdog([](auto) {
      std::printf("%.6f watchdog expired\n", unix_now());
      std::fflush(stdout);
    });
    std::signal(SIGINT, [](int) { stopping = true; });
    std::signal(SIGTERM, [](int) { stopping = true; });
    std::printf("simulated output module listening on %s:%d\n", address.c_str(), module.port());
    std::fflush(stdout);
    while (!stopping) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
