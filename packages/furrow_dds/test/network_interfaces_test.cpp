#include "network_interfaces.hpp"

#include <gtest/gtest.h>

#include "furrow_core/error.hpp"

namespace furrow::dds {
namespace {

TEST(NetworkInterfaces, FindsLoopback) {
  EXPECT_NO_THROW(wait_for_interfaces({"127.0.0.1"}, std::chrono::milliseconds(0)));
  EXPECT_NO_THROW(wait_for_interfaces({}, std::chrono::milliseconds(0)));
}

TEST(NetworkInterfaces, NamesAMissingAddress) {
  try {
    // An address for documentation, RFC 5737.
    wait_for_interfaces({"127.0.0.1", "192.0.2.7"}, std::chrono::milliseconds(50));
    FAIL() << "192.0.2.7 was found";
  } catch (const ConfigError& error) {
    EXPECT_NE(std::string(error.what()).find("'192.0.2.7'"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace furrow::dds
