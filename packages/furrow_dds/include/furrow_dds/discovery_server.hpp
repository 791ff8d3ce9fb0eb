#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace furrow::dds {

/// Lets processes with discovery "discovery_server" find each other; it carries no topics. It uses
/// the ids of Fast DDS's own tool, which can replace it.
class DiscoveryServer {
 public:
  /// `address`: IPv4 address of this host, with an optional ":port" (default 11811). `id`: index in
  /// the lists of `peers`, 0 to 255. Throws ConfigError.
  DiscoveryServer(std::int64_t domain_id, const std::string& address, std::int64_t id = 0);
  ~DiscoveryServer();
  DiscoveryServer(const DiscoveryServer&) = delete;
  DiscoveryServer& operator=(const DiscoveryServer&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::dds
