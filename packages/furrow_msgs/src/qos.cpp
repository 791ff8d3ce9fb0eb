#include "furrow_msgs/qos.hpp"

namespace furrow::msgs {
namespace {

std::string milliseconds(Duration duration) {
  if (duration == Duration()) return "none";
  return std::to_string(duration.count_ns() / 1'000'000) + " ms";
}

/// A zero duration is infinite.
bool is_longer(Duration offered, Duration requested) {
  return requested > Duration() && (offered == Duration() || offered > requested);
}

}  // namespace

std::string_view to_string(Reliability reliability) {
  return reliability == Reliability::kReliable ? "reliable" : "best effort";
}

std::string_view to_string(Durability durability) {
  return durability == Durability::kTransientLocal ? "transient local" : "volatile";
}

std::string incompatibility(const Qos& offered, const Qos& requested) {
  std::string text;
  const auto add = [&text](std::string_view policy, std::string_view offer,
                           std::string_view request) {
    if (!text.empty()) text += "; ";
    text.append(policy).append(": offered ").append(offer);
    text.append(", requested ").append(request);
  };
  if (!requested.accept_best_effort && offered.reliability < requested.reliability) {
    add("reliability", to_string(offered.reliability), to_string(requested.reliability));
  }
  if (offered.durability < requested.durability) {
    add("durability", to_string(offered.durability), to_string(requested.durability));
  }
  if (is_longer(offered.deadline, requested.deadline)) {
    add("deadline", milliseconds(offered.deadline), milliseconds(requested.deadline));
  }
  if (is_longer(offered.liveliness_lease, requested.liveliness_lease)) {
    add("liveliness lease", milliseconds(offered.liveliness_lease),
        milliseconds(requested.liveliness_lease));
  }
  return text;
}

}  // namespace furrow::msgs
