#include "furrow_graph/stamp.hpp"

#include "furrow_msgs/builtin_interfaces.h"

namespace furrow::graph {
namespace {
constexpr std::int64_t kNsPerSecond = 1'000'000'000;
}

Time from_msg(const builtin_interfaces::msg::Time& stamp) {
  return Time::from_nanoseconds(stamp.sec() * kNsPerSecond + stamp.nanosec());
}

builtin_interfaces::msg::Time to_msg(Time time) {
  std::int64_t seconds = time.count_ns() / kNsPerSecond;
  std::int64_t rest_ns = time.count_ns() % kNsPerSecond;
  if (rest_ns < 0) {
    rest_ns += kNsPerSecond;
    --seconds;
  }
  builtin_interfaces::msg::Time stamp;
  stamp.sec(static_cast<std::int32_t>(seconds));
  stamp.nanosec(static_cast<std::uint32_t>(rest_ns));
  return stamp;
}

}  // namespace furrow::graph
