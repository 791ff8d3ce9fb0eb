#include <gtest/gtest.h>

#include <functional>
#include <utility>

#include "test_support.hpp"

namespace furrow::dds {
namespace {

TEST(DdsParameters, LoadFromGivenValues) {
  DdsParameters parameters;
  ParameterLoader::load(
      {{"domain_id", std::int64_t{7}, {}}, {"transports", std::vector<std::string>{"udp"}, {}}},
      parameters);
  EXPECT_EQ(parameters.domain_id, 7);
  EXPECT_EQ(parameters.transports, std::vector<std::string>{"udp"});
  EXPECT_EQ(parameters.interfaces, std::vector<std::string>{"127.0.0.1"});
}

TEST(DdsParameters, BadValuesAreRefusedAtConstruction) {
  using Change = std::function<void(DdsParameters&)>;
  const std::vector<std::pair<const char*, Change>> cases = {
      {"domain", [](DdsParameters& p) { p.domain_id = 233; }},
      {"transport", [](DdsParameters& p) { p.transports = {"tcp"}; }},
      {"no transport", [](DdsParameters& p) { p.transports = {}; }},
      {"interface", [](DdsParameters& p) { p.interfaces = {"eth0"}; }},
      {"discovery", [](DdsParameters& p) { p.discovery = "guessing"; }},
      {"peers with multicast", [](DdsParameters& p) { p.peers = {"127.0.0.1"}; }},
      {"no peers", [](DdsParameters& p) { p.discovery = "static_peers"; }},
      {"host name",
       [](DdsParameters& p) { p.discovery = "static_peers", p.peers = {"robot.local"}; }},
      {"port",
       [](DdsParameters& p) { p.discovery = "static_peers", p.peers = {"127.0.0.1:70000"}; }},
      {"trailing text",
       [](DdsParameters& p) { p.discovery = "discovery_server", p.peers = {"127.0.0.1:80x"}; }},
      {"server without udp",
       [](DdsParameters& p) {
         p.discovery = "discovery_server", p.peers = {"127.0.0.1"}, p.transports = {"shm"};
       }},
      {"lease", [](DdsParameters& p) { p.lease_s = 0.0; }},
      {"segment", [](DdsParameters& p) { p.shm_segment_mb = 5000; }},
  };
  for (const auto& [name, change] : cases) {
    DdsParameters parameters = test_parameters("bad");
    change(parameters);
    EXPECT_THROW(DdsTransport{parameters}, ConfigError) << name;
  }
}

}  // namespace
}  // namespace furrow::dds
