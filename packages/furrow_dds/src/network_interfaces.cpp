#include "network_interfaces.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <thread>

#include "furrow_core/error.hpp"

namespace furrow::dds {
namespace {

std::vector<std::string> running_addresses() {
  ifaddrs* first = nullptr;
  if (getifaddrs(&first) != 0) return {};
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> list(first, &freeifaddrs);
  std::vector<std::string> addresses;
  for (const ifaddrs* entry = list.get(); entry != nullptr; entry = entry->ifa_next) {
    constexpr unsigned kRunning = IFF_UP | IFF_RUNNING;
    if (entry->ifa_addr == nullptr || entry->ifa_addr->sa_family != AF_INET) continue;
    if ((entry->ifa_flags & kRunning) != kRunning) continue;
    const auto* address = reinterpret_cast<const sockaddr_in*>(entry->ifa_addr);
    std::array<char, INET_ADDRSTRLEN> text{};
    inet_ntop(AF_INET, &address->sin_addr, text.data(), text.size());
    addresses.emplace_back(text.data());
  }
  return addresses;
}

}  // namespace

void wait_for_interfaces(const std::vector<std::string>& addresses,
                         std::chrono::milliseconds patience) {
  constexpr std::chrono::milliseconds kPause{20};
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (true) {
    const std::vector<std::string> running = running_addresses();
    const auto missing = std::ranges::find_if(addresses, [&](const std::string& address) {
      return std::ranges::find(running, address) == running.end();
    });
    if (missing == addresses.end()) return;
    if (std::chrono::steady_clock::now() >= deadline) {
      throw ConfigError("interfaces: no running network interface has the address '" + *missing +
                        "'");
    }
    std::this_thread::sleep_for(kPause);
  }
}

std::uint16_t free_udp_port() {
  const int probe = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t size = sizeof(address);
  auto* any = reinterpret_cast<sockaddr*>(&address);
  const bool given =
      probe >= 0 && ::bind(probe, any, size) == 0 && ::getsockname(probe, any, &size) == 0;
  if (probe >= 0) ::close(probe);
  if (!given) throw ConfigError("no UDP port is free on this host");
  return ntohs(address.sin_port);
}

}  // namespace furrow::dds
