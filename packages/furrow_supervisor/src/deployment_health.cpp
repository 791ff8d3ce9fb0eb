#include "furrow_supervisor/deployment_health.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::supervisor {
namespace {

constexpr std::array<const char*, 4> kLevels = {"ok", "warning", "error", "stale"};

constexpr std::uint8_t kError = 2;
constexpr std::chrono::seconds kBetweenResets{1};

// Causes that pass when the process or the network is back.
bool lost_a_peer(const diagnostic_msgs::msg::DiagnosticStatus& status) {
  constexpr std::array<std::string_view, 3> kCauses = {"peer_lost", "plan_stale", "odometry_stale"};
  return status.level() == kError && std::ranges::any_of(kCauses, [&](std::string_view cause) {
           return status.message().starts_with(cause);
         });
}

}  // namespace

DeploymentHealth::DeploymentHealth(const dds::DdsParameters& parameters, bool resume)
    : resume_(resume) {
  dds::DdsParameters own = parameters;
  own.process_name = "furrow_up";
  // It sends nothing.
  own.shm_segment_mb = 1;
  transport_ = std::make_unique<dds::DdsTransport>(own);
  if (resume_) {
    const msgs::Topic& reset = msgs::topics::ToolReset::topic();
    reset_ = transport_->make_writer(std::string(reset.name), *reset.type, reset.qos);
  }
  const msgs::Topic& topic = msgs::topics::Diagnostics::topic();
  reader_ = transport_->make_reader(
      std::string(topic.name), *topic.type, topic.qos, [this](const graph::MessagePtr& message) {
        take(*static_cast<const diagnostic_msgs::msg::DiagnosticArray*>(message.get()));
      });
}

void DeploymentHealth::take(const diagnostic_msgs::msg::DiagnosticArray& array) {
  const std::lock_guard lock(mutex_);
  for (const auto& status : array.status()) {
    if (!lost_a_peer(status)) {
      cut_off_.erase(status.name());
    } else if (cut_off_.size() < kMaxNames) {
      cut_off_.insert(status.name());
    }
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

std::vector<std::string> DeploymentHealth::tick() {
  if (resume_) resume_tools();
  const std::lock_guard lock(mutex_);
  return std::exchange(changes_, {});
}

void DeploymentHealth::resume_tools() {
  const auto now = std::chrono::steady_clock::now();
  const std::lock_guard lock(mutex_);
  if (cut_off_.empty() || now - last_reset_ < kBetweenResets) return;
  last_reset_ = now;
  changes_.push_back("tools that lost a peer: told to start again");
  reset_->write(std::make_shared<const furrow_msgs::msg::ToolReset>());
}

}  // namespace furrow::supervisor
