#include "participant_qos.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastdds/rtps/transport/shared_mem/SharedMemTransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>

#include "endpoint_qos.hpp"
#include "furrow_msgs/type_names.hpp"
#include "network_interfaces.hpp"
#include "shared_memory.hpp"

namespace furrow::dds {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;
using eprosima::fastdds::rtps::RemoteServerAttributes;
using eprosima::fastdds::rtps::SharedMemTransportDescriptor;
using eprosima::fastdds::rtps::UDPv4TransportDescriptor;

namespace {

// Static peers are asked on the ports of this many processes per host.
constexpr std::uint32_t kMaxProcessesPerHost = 32;
// In fragments of 64 kB; a port's queue must hold those of several images.
constexpr std::uint32_t kShmPortQueue = 1024;

bool has(const std::vector<std::string>& list, const char* entry) {
  return std::find(list.begin(), list.end(), entry) != list.end();
}

/// Discovery and small messages use UDP, so that the shared memory of a crashed process cannot
/// block them. Port 0 means the port of the RTPS standard.
void listen_on_udp(fdds::WireProtocolConfigQos& protocol) {
  rtps::Locator_t any;
  any.kind = LOCATOR_KIND_UDPv4;
  any.port = 0;
  protocol.default_unicast_locator_list.push_back(any);
  protocol.builtin.metatrafficUnicastLocatorList.push_back(any);
  rtps::Locator_t group = any;
  rtps::IPLocator::setIPv4(group, 239, 255, 0, 1);
  protocol.builtin.metatrafficMulticastLocatorList.push_back(group);
}

void set_transports(const DdsParameters& parameters, fdds::DomainParticipantQos& qos) {
  qos.transport().use_builtin_transports = false;
  for (const std::string& name : parameters.transports) {
    if (name != "shm" && name != "udp") {
      throw ConfigError("transports: '" + name + "' must be \"shm\" or \"udp\"");
    }
  }
  if (has(parameters.transports, "shm")) {
    auto shm = std::make_shared<SharedMemTransportDescriptor>();
    shm->segment_size(static_cast<std::uint32_t>(parameters.shm_segment_mb * 1'000'000));
    shm->port_queue_capacity(kShmPortQueue);
    qos.transport().user_transports.push_back(shm);
    if (!has(parameters.transports, "udp")) {
      qos.wire_protocol().default_unicast_locator_list = own_shm_locators(*shm);
    }
  }
  if (has(parameters.transports, "udp")) {
    auto udp = std::make_shared<UDPv4TransportDescriptor>();
    const auto buffer_bytes = static_cast<std::uint32_t>(parameters.socket_buffer_kb * 1000);
    udp->sendBufferSize = buffer_bytes;
    udp->receiveBufferSize = buffer_bytes;
    udp->maxInitialPeersRange = kMaxProcessesPerHost;
    for (const std::string& address : parameters.interfaces) {
      if (!rtps::IPLocator::isIPv4(address)) {
        throw ConfigError("interfaces: '" + address + "' is not an IPv4 address");
      }
      udp->interfaceWhiteList.push_back(address);
    }
    qos.transport().user_transports.push_back(udp);
    listen_on_udp(qos.wire_protocol());
  }
  if (qos.transport().user_transports.empty()) {
    throw ConfigError("transports: must name \"shm\", \"udp\" or both");
  }
}

void set_discovery(const DdsParameters& parameters, fdds::DomainParticipantQos& qos) {
  auto& builtin = qos.wire_protocol().builtin;
  const Duration lease = Duration::seconds(parameters.lease_s);
  builtin.discovery_config.leaseDuration = to_dds(lease);
  builtin.discovery_config.leaseDuration_announcementperiod =
      to_dds(Duration::nanoseconds(lease.count_ns() / 3));
  builtin.discovery_config.initial_announcements = {10, to_dds(Duration::milliseconds(50))};

  const bool udp = has(parameters.transports, "udp");
  if (parameters.discovery == "multicast") {
    if (!parameters.peers.empty()) {
      throw ConfigError("peers: must be empty with discovery \"multicast\"");
    }
    return;
  }
  if (!udp || parameters.peers.empty()) {
    throw ConfigError("discovery: \"" + parameters.discovery +
                      "\" requires peers, and \"udp\" among the transports");
  }
  if (parameters.discovery == "static_peers") {
    for (const std::string& peer : parameters.peers) {
      builtin.initialPeersList.push_back(udp_locator(peer, 0));
    }
    // Other processes of this host are peers too.
    if (parameters.interfaces.empty()) {
      builtin.initialPeersList.push_back(udp_locator("127.0.0.1", 0));
    }
    for (const std::string& address : parameters.interfaces) {
      builtin.initialPeersList.push_back(udp_locator(address, 0));
    }
    return;
  }
  if (parameters.discovery != "discovery_server") {
    throw ConfigError("discovery: '" + parameters.discovery +
                      "' must be \"multicast\", \"static_peers\" or \"discovery_server\"");
  }
  if (parameters.peers.size() > kMaxDiscoveryServers) {
    throw ConfigError("peers: at most 256 discovery servers");
  }
  // Learns of all topics, not only its own, for recorders and tools.
  builtin.discovery_config.discoveryProtocol = rtps::DiscoveryProtocol_t::SUPER_CLIENT;
  builtin.discovery_config.discoveryServer_client_syncperiod = to_dds(Duration::milliseconds(100));
  for (std::size_t id = 0; id < parameters.peers.size(); ++id) {
    RemoteServerAttributes server;
    server.guidPrefix = discovery_server_prefix(static_cast<std::uint8_t>(id));
    server.metatrafficUnicastLocatorList.push_back(
        udp_locator(parameters.peers[id], kDiscoveryServerPort));
    builtin.discovery_config.m_DiscoveryServers.push_back(server);
  }
}

/// The value of `key`, or "".
std::string user_data_value(const std::string& user_data, const std::string& key) {
  const std::string prefix = key + "=";
  std::size_t begin = 0;
  while (begin < user_data.size()) {
    const std::size_t end = std::min(user_data.find(';', begin), user_data.size());
    if (user_data.compare(begin, prefix.size(), prefix) == 0) {
      return user_data.substr(begin + prefix.size(), end - begin - prefix.size());
    }
    begin = end + 1;
  }
  return {};
}

}  // namespace

rtps::Locator_t udp_locator(const std::string& address, std::uint32_t default_port) {
  const std::size_t colon = address.find(':');
  const std::string host = address.substr(0, colon);
  std::uint32_t port = default_port;
  if (colon != std::string::npos) {
    const char* first = address.data() + colon + 1;
    const char* last = address.data() + address.size();
    const auto [end, failure] = std::from_chars(first, last, port);
    if (failure != std::errc() || end != last || port == 0 || port > 65535) {
      throw ConfigError("address '" + address +
                        "' must have a port from 1 to 65535 after the colon");
    }
  }
  if (!rtps::IPLocator::isIPv4(host)) {
    throw ConfigError("address '" + address + "' is not an IPv4 address");
  }
  rtps::Locator_t locator;
  rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, host, port, locator);
  return locator;
}

rtps::GuidPrefix_t discovery_server_prefix(std::uint8_t id) {
  RemoteServerAttributes server;
  server.ReadguidPrefix(eprosima::fastdds::rtps::DEFAULT_ROS2_SERVER_GUIDPREFIX);
  server.guidPrefix.value[2] = id;
  return server.guidPrefix;
}

fdds::DomainParticipantQos participant_qos(const DdsParameters& parameters) {
  validate_parameters(parameters);

  fdds::DomainParticipantQos qos = fdds::PARTICIPANT_QOS_DEFAULT;
  qos.name(parameters.process_name);
  const std::string user_data = process_user_data();
  qos.user_data().setValue({user_data.begin(), user_data.end()});
  // Each sending thread has its own buffer and waits for no other thread.
  qos.allocation().send_buffers.dynamic = true;
  set_transports(parameters, qos);
  set_discovery(parameters, qos);
  return qos;
}

rtps::LocatorList_t reader_locators(const DdsParameters& parameters, const std::string& type_name) {
  if (!has(parameters.transports, "shm") || !has(parameters.transports, "udp") ||
      !has(parameters.shm_types, msgs::ros_type_name(type_name).c_str())) {
    return {};
  }
  rtps::LocatorList_t own = own_shm_locators(SharedMemTransportDescriptor());
  rtps::Locator_t udp;
  udp.kind = LOCATOR_KIND_UDPv4;
  udp.port = free_udp_port();
  own.push_back(udp);
  return own;
}

std::string process_user_data() {
  std::array<char, 256> host{};
  if (gethostname(host.data(), host.size() - 1) != 0) {
    host = {"unknown"};
  }
  return "furrow=1;host=" + std::string(host.data()) + ";pid=" + std::to_string(getpid()) + ";";
}

void read_user_data(const std::string& user_data, ProcessInfo& process) {
  process.host = user_data_value(user_data, "host");
  const std::string pid = user_data_value(user_data, "pid");
  std::from_chars(pid.data(), pid.data() + pid.size(), process.pid);
}

}  // namespace furrow::dds
