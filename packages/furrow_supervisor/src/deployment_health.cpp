#include "furrow_supervisor/deployment_health.hpp"

#include <array>
#include <utility>

#include "furrow_msgs/enums.hpp"
#include "furrow_msgs/furrow_msgs.h"
#include "furrow_msgs/topics.hpp"

namespace furrow::supervisor {
namespace {

constexpr std::array<const char*, 4> kLevels = {"ok", "warning", "error", "stale"};

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
    const msgs::Topic& state = msgs::topics::AxisState::topic();
    states_ = transport_->make_reader(
        std::string(state.name), *state.type, state.qos, [this](const graph::MessagePtr& message) {
          const std::lock_guard lock(mutex_);
          policy_.take(*static_cast<const furrow_msgs::msg::AxisState*>(message.get()));
        });
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
  const std::lock_guard lock(mutex_);
  for (auto& reset : policy_.due(ResumePolicy::Clock::now())) {
    changes_.push_back(reset.axis() + ": reset of " + msgs::to_string(reset.cause()));
    reset_->write(std::make_shared<const furrow_msgs::msg::ToolReset>(std::move(reset)));
  }
}

}  // namespace furrow::supervisor
