#include "furrow_dds/discovery_server.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <fastdds/dds/domain/DomainParticipantFactory.hpp>

#include "participant.hpp"
#include "participant_qos.hpp"

namespace furrow::dds {

namespace fdds = eprosima::fastdds::dds;

struct DiscoveryServer::Impl {
  ParticipantHandle participant;
};

DiscoveryServer::DiscoveryServer(std::int64_t domain_id, const std::string& address,
                                 std::int64_t id) {
  if (domain_id < 0 || domain_id > 232) {
    throw ConfigError("discovery server: the domain must be from 0 to 232");
  }
  if (id < 0 || id >= kMaxDiscoveryServers) {
    throw ConfigError("discovery server: the id must be from 0 to 255");
  }
  const auto locator = udp_locator(address, kDiscoveryServerPort);
  fdds::DomainParticipantQos qos = fdds::PARTICIPANT_QOS_DEFAULT;
  qos.name("discovery_server");
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList.push_back(address.substr(0, address.find(':')));
  qos.transport().user_transports.push_back(udp);
  qos.wire_protocol().prefix = discovery_server_prefix(static_cast<std::uint8_t>(id));
  auto& builtin = qos.wire_protocol().builtin;
  builtin.discovery_config.discoveryProtocol =
      eprosima::fastrtps::rtps::DiscoveryProtocol_t::SERVER;
  builtin.metatrafficUnicastLocatorList.push_back(locator);
  ParticipantHandle participant(fdds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<fdds::DomainId_t>(domain_id), qos, nullptr, fdds::StatusMask::none()));
  if (participant == nullptr) {
    throw ConfigError("discovery server: refused at " + address +
                      ": not an address of this host, or another server is there");
  }
  impl_.reset(new Impl{std::move(participant)});
}

DiscoveryServer::~DiscoveryServer() = default;

}  // namespace furrow::dds
