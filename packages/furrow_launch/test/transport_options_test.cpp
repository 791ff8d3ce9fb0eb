#include "furrow_launch/transport_options.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "furrow_core/error.hpp"

namespace furrow::launch {
namespace {

/// Sets ROS_DOMAIN_ID as long as it lives; null: unset.
class RosDomain {
 public:
  explicit RosDomain(const char* value) {
    if (const char* kept = std::getenv("ROS_DOMAIN_ID")) kept_ = kept;
    set(value);
  }
  ~RosDomain() { set(kept_ ? kept_->c_str() : nullptr); }

 private:
  static void set(const char* value) {
    if (value == nullptr) {
      unsetenv("ROS_DOMAIN_ID");
    } else {
      setenv("ROS_DOMAIN_ID", value, 1);
    }
  }
  std::optional<std::string> kept_;
};

std::int64_t domain_of(const TransportOptions& options) {
  return transport_parameters(options, "test").domain_id;
}

TEST(TransportOptions, DomainIsThatOfTheEnvironmentUnlessItIsGiven) {
  {
    const RosDomain unset(nullptr);
    EXPECT_EQ(domain_of({}), 0);
  }
  const RosDomain environment("42");
  EXPECT_EQ(domain_of({}), 42);
  EXPECT_EQ(domain_of({.domain_id = 7}), 7);
  EXPECT_EQ(domain_of({.domain_id = 7, .settings = {"domain_id=8"}}), 8);
}

TEST(TransportOptions, BadEnvironmentIsRefused) {
  for (const char* bad : {"x", "1x", "-1", "233", "1.5", " 1"}) {
    const RosDomain environment(bad);
    EXPECT_THROW((void)domain_of({}), ConfigError) << bad;
    EXPECT_EQ(domain_of({.domain_id = 7}), 7);
  }
  const RosDomain empty("");
  EXPECT_EQ(domain_of({}), 0);
}

}  // namespace
}  // namespace furrow::launch
