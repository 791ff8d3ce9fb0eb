#include "supervisor_health.hpp"

#include <array>
#include <utility>

#include "furrow_msgs/topics.hpp"

namespace furrow::cli {
namespace {

constexpr std::array<const char*, 4> kLevels = {"ok", "warning", "error", "stale"};

}  // namespace

SupervisorHealth::SupervisorHealth(const dds::DdsParameters& parameters) {
  dds::DdsParameters own = parameters;
  own.process_name = "furrow_up";
  // It sends nothing.
  own.shm_segment_mb = 1;
  transport_ = std::make_unique<dds::DdsTransport>(own);
  const msgs::Topic& topic = msgs::topics::Diagnostics::topic();
  reader_ = transport_->make_reader(
      std::string(topic.name), *topic.type, topic.qos, [this](const graph::MessagePtr& message) {
        take(*static_cast<const diagnostic_msgs::msg::DiagnosticArray*>(message.get()));
      });
}

void SupervisorHealth::take(const diagnostic_msgs::msg::DiagnosticArray& array) {
  const std::lock_guard lock(mutex_);
  for (const auto& status : array.status()) {
    const auto known = levels_.find(status.name());
    const std::uint8_t before = known == levels_.end() ? 0 : known->second;
    if (status.level() == before || status.level() >= kLevels.size()) continue;
    if (known == levels_.end() && levels_.size() == kMaxNames) continue;
    if (status.level() == 0) {
      levels_.erase(known);
    } else {
      levels_[status.name()] = status.level();
    }
    if (changes_.size() == kMaxLines) continue;
    changes_.push_back(status.name() + ": " + kLevels[status.level()] +
                       (status.message().empty() ? "" : ": " + status.message()));
  }
}

std::vector<std::string> SupervisorHealth::take_changes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(changes_, {});
}

}  // namespace furrow::cli
