#pragma once

#include "furrow_core/time.hpp"

namespace builtin_interfaces::msg {
class Time;
}

namespace furrow::graph {

[[nodiscard]] Time from_msg(const builtin_interfaces::msg::Time& stamp);
[[nodiscard]] builtin_interfaces::msg::Time to_msg(Time time);

}  // namespace furrow::graph
