#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace furrow::dds {

/// Waits until an interface that is up and running has each of these IPv4 addresses: Fast DDS would
/// go on without those that are not there yet, and would never look again. Throws ConfigError that
/// names the first address that did not come within `patience`.
void wait_for_interfaces(const std::vector<std::string>& addresses,
                         std::chrono::milliseconds patience);

/// A UDP port that nobody on this host had a moment ago, of those that the system gives away.
/// Throws ConfigError when there is none.
[[nodiscard]] std::uint16_t free_udp_port();

}  // namespace furrow::dds
