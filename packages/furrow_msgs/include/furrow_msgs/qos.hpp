#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "furrow_core/time.hpp"

namespace furrow::msgs {

enum class Reliability : std::uint8_t { kBestEffort, kReliable };
enum class Durability : std::uint8_t { kVolatile, kTransientLocal };
[[nodiscard]] std::string_view to_string(Reliability reliability);
[[nodiscard]] std::string_view to_string(Durability durability);

/// The quality of service of a topic: DDS policies, and the depth of the mailboxes inside a
/// process.
struct Qos {
  Reliability reliability = Reliability::kReliable;  ///< offered by writers, requested by readers
  Durability durability = Durability::kVolatile;
  int depth = 10;             ///< KEEP_LAST; a full mailbox drops its oldest message, counted
  Duration deadline;          ///< the longest time between two messages; zero: not watched
  Duration liveliness_lease;  ///< how soon a dead writer is noticed; zero: not watched
  /// Readers also accept writers that offer best effort, without liveliness or deadline.
  bool accept_best_effort = false;
  Duration lifespan = {};  ///< of a message on its way to other processes; zero: unlimited
};

/// The policies with which a reader requests more than a writer offers, and so is not matched, as
/// "reliability: offered best effort, requested reliable". Empty: the two are compatible.
[[nodiscard]] std::string incompatibility(const Qos& offered, const Qos& requested);

/// A reliable stream of states: the newest message counts.
[[nodiscard]] constexpr Qos reliable_stream_qos(int depth = 2) {
  return {.reliability = Reliability::kReliable, .depth = depth};
}
/// A sensor's stream: our writers are reliable, for large images; readers also accept best effort,
/// which ROS 2 sensor drivers offer (REP 2003).
[[nodiscard]] constexpr Qos sensor_stream_qos(int depth = 2) {
  return {.reliability = Reliability::kReliable, .depth = depth, .accept_best_effort = true};
}
/// State that a late joiner must get.
[[nodiscard]] constexpr Qos latched_qos() {
  return {.durability = Durability::kTransientLocal, .depth = 1};
}
/// Events of which none may be lost.
[[nodiscard]] constexpr Qos event_qos() {
  return {.depth = 1000};
}

/// The log, with the profile of ROS 2's /rosout.
[[nodiscard]] constexpr Qos rosout_qos() {
  return {.durability = Durability::kTransientLocal,
          .depth = 1000,
          .lifespan = Duration::milliseconds(10'000)};
}

}  // namespace furrow::msgs
