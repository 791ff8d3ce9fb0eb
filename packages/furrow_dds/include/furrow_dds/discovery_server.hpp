#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace furrow::dds {

/// The place where processes with discovery "discovery_server" find each other. It carries no
/// topics. Others may take its place: it follows the ids of Fast DDS's own tool.
class DiscoveryServer {
 public:
  /// `address`: IPv4 of this host to listen at, with an optional ":port" (11811 unless given);
  /// `id`: its place in the lists of `peers`, 0 to 255. Throws ConfigError.
  DiscoveryServer(std::int64_t domain_id, const std::string& address, std::int64_t id = 0);
  ~DiscoveryServer();
  DiscoveryServer(const DiscoveryServer&) = delete;
  DiscoveryServer& operator=(const DiscoveryServer&) = delete;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::dds
