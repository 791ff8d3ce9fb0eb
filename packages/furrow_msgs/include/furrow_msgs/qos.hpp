#pragma once

#include <cstdint>

#include "furrow_core/time.hpp"

namespace furrow::msgs {

enum class Reliability : std::uint8_t { kBestEffort, kReliable };
enum class Durability : std::uint8_t { kVolatile, kTransientLocal };

/// The quality of service of a topic: DDS's policies, and the bound of the mailboxes inside a
/// process. A zero duration means: not watched.
struct Qos {
  Reliability reliability = Reliability::kReliable;
  Durability durability = Durability::kVolatile;
  int depth = 10;             ///< KEEP_LAST; a full mailbox drops its oldest message, counted
  Duration deadline;          ///< the longest time between two messages
  Duration liveliness_lease;  ///< how soon a dead writer is noticed
};

/// Sensor streams: the newest matters, an old one does not.
[[nodiscard]] constexpr Qos sensor_qos(int depth = 2) {
  return {.reliability = Reliability::kReliable, .depth = depth};
}
/// State that a late joiner must get.
[[nodiscard]] constexpr Qos latched_qos() {
  return {.durability = Durability::kTransientLocal, .depth = 1};
}
/// Events, each of which counts.
[[nodiscard]] constexpr Qos event_qos() {
  return {.depth = 1000};
}

}  // namespace furrow::msgs
