#include "topic_subscription.hpp"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

namespace furrow::cli {

std::string topic_name(const std::string& given) {
  return given.starts_with('/') ? given.substr(1) : given;
}

bool wait_for_discovery(const dds::DdsTransport& transport, double seconds,
                        const std::function<bool()>& stopped,
                        const std::function<bool(const dds::DiscoverySnapshot&)>& found) {
  using SteadyClock = std::chrono::steady_clock;
  const auto deadline = SteadyClock::now() + std::chrono::duration<double>(seconds);
  while (!found(transport.discovery())) {
    if (SteadyClock::now() >= deadline || stopped()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

std::optional<PublishedTopic> wait_for_topic(const dds::DdsTransport& transport,
                                             const std::string& name, double seconds,
                                             const std::function<bool()>& stopped) {
  PublishedTopic topic;
  const bool found =
      wait_for_discovery(transport, seconds, stopped, [&](const dds::DiscoverySnapshot& snapshot) {
        const auto it = std::ranges::find(snapshot.topics, name, &dds::TopicInfo::name);
        if (it == snapshot.topics.end() || it->writers.empty()) return false;
        topic.dds_type = it->type_names.front();
        topic.qos = it->writers.front().qos;
        return true;
      });
  if (!found) return std::nullopt;
  topic.qos.depth = 10;
  topic.qos.deadline = Duration();
  topic.qos.liveliness_lease = Duration();
  return topic;
}

TopicSubscription::TopicSubscription(dds::DdsTransport& transport, const std::string& name,
                                     const PublishedTopic& topic)
    : reader_(transport.make_raw_reader(
          name, topic.dds_type, topic.qos,
          [this](dds::RawMessage message) { push(std::move(message)); })) {}

std::optional<dds::RawMessage> TopicSubscription::next(double timeout_s) {
  std::unique_lock lock(mutex_);
  wake_.wait_for(lock, std::chrono::duration<double>(timeout_s),
                 [this] { return stopped_ || !messages_.empty(); });
  if (stopped_ || messages_.empty()) return std::nullopt;
  dds::RawMessage message = std::move(messages_.front());
  messages_.pop_front();
  return message;
}

void TopicSubscription::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
  wake_.notify_all();
}

bool TopicSubscription::stopped() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

void TopicSubscription::push(dds::RawMessage message) {
  const std::lock_guard lock(mutex_);
  if (messages_.size() == kMaxWaiting) messages_.pop_front();
  messages_.push_back(std::move(message));
  wake_.notify_one();
}

}  // namespace furrow::cli
