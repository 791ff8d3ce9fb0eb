#include "furrow_recording/latched_messages.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/tf2_msgs.h"

namespace furrow::recording {
namespace {

constexpr std::size_t kMaxLatchedDepth = 100;
constexpr std::string_view kTransformType = "tf2_msgs/msg/TFMessage";

/// As many as the channel's latched publishers keep together. A depth that is not known counts as
/// one, which is what ROS 2's latched topics use.
std::size_t latched_depth(const TopicDescription& topic) {
  std::size_t depth = 0;
  for (const msgs::Qos& qos : topic.offered_qos) {
    if (qos.durability == msgs::Durability::kTransientLocal) {
      depth += static_cast<std::size_t>(std::max(qos.depth, 1));
    }
  }
  return std::clamp<std::size_t>(depth, 1, kMaxLatchedDepth);
}

/// The child frames of a TFMessage; none when it is malformed or empty.
std::optional<std::vector<std::string>> child_frames(const Payload& payload) {
  tf2_msgs::msg::TFMessage message;
  if (!msgs::message_type<tf2_msgs::msg::TFMessage>().deserialize(*payload, &message)) {
    return std::nullopt;
  }
  std::vector<std::string> children;
  for (const auto& transform : message.transforms()) {
    children.push_back(transform.child_frame_id());
  }
  return children.empty() ? std::nullopt : std::optional(std::move(children));
}

}  // namespace

void LatchedMessages::add_channel(std::size_t channel, const TopicDescription& topic) {
  if (topic.latched()) {
    const bool transforms = topic.is_static_transforms() && topic.type_name == kTransformType;
    channels_[channel] = {topic.name, latched_depth(topic), transforms};
  }
}

void LatchedMessages::add(KeptMessage message) {
  const auto at = channels_.find(message.channel);
  if (at == channels_.end() || !message.payload) {
    return;
  }
  const Channel& channel = at->second;
  if (channel.static_transforms) {
    if (auto children = child_frames(message.payload)) {
      add_transforms(channel, std::move(message), std::move(*children));
      return;
    }
  }
  auto& kept = last_[message.channel];
  kept.push_back(std::move(message));
  if (kept.size() > channel.depth) {
    kept.pop_front();
  }
}

void LatchedMessages::add_transforms(const Channel& channel, KeptMessage message,
                                     std::vector<std::string> children) {
  auto& kept = transforms_[channel.topic];
  for (TransformMessage& earlier : kept) {
    std::erase_if(earlier.children, [&children](const std::string& child) {
      return std::ranges::find(children, child) != children.end();
    });
  }
  std::erase_if(kept, [](const TransformMessage& earlier) { return earlier.children.empty(); });
  kept.push_back({std::move(message), std::move(children)});
}

std::vector<KeptMessage> LatchedMessages::take() {
  std::vector<KeptMessage> all;
  for (auto& [channel, kept] : last_) {
    std::ranges::move(kept, std::back_inserter(all));
  }
  for (auto& [topic, kept] : transforms_) {
    for (TransformMessage& transform : kept) {
      all.push_back(std::move(transform.message));
    }
  }
  last_.clear();
  transforms_.clear();
  std::ranges::stable_sort(all, {}, &KeptMessage::log_time);
  return all;
}

}  // namespace furrow::recording
