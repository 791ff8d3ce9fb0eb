#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace furrow::dds {

/// Waits until a running interface has each of these IPv4 addresses. Fast DDS would start without a
/// missing one and never look again. Throws ConfigError with the first address that is missing
/// after `patience`.
void wait_for_interfaces(const std::vector<std::string>& addresses,
                         std::chrono::milliseconds patience);

/// An ephemeral UDP port that was free a moment ago. Throws ConfigError if there is none.
[[nodiscard]] std::uint16_t free_udp_port();

}  // namespace furrow::dds
