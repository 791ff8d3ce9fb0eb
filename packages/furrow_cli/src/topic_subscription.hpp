#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_msgs/topics.hpp"

namespace furrow::cli {

/// The name of a topic as Furrow writes it, from the name that a user gives: ROS 2 writes
/// "/wheel/odometry" for "wheel/odometry".
[[nodiscard]] std::string topic_name(const std::string& given);

/// Polls the discovery until `found` holds, or the time is over or `stopped` returns true; false
/// then. Discovery has no end to wait for.
[[nodiscard]] bool wait_for_discovery(
    const dds::DdsTransport& transport, double seconds, const std::function<bool()>& stopped,
    const std::function<bool(const dds::DiscoverySnapshot&)>& found);

/// What a reader of a topic must know.
struct PublishedTopic {
  std::string dds_type;
  msgs::Qos qos;  ///< of the first writer, without deadline and lease
};

/// Waits for a writer of the topic; nothing when none comes in time.
[[nodiscard]] std::optional<PublishedTopic> wait_for_topic(const dds::DdsTransport& transport,
                                                           const std::string& name, double seconds,
                                                           const std::function<bool()>& stopped);

/// Messages of one topic, moved from the receive thread to the caller's. Of more than a thousand
/// that wait, the oldest are dropped.
class TopicSubscription {
 public:
  TopicSubscription(dds::DdsTransport& transport, const std::string& name,
                    const PublishedTopic& topic);

  /// The next message; nothing when it does not come in time, or after stop().
  [[nodiscard]] std::optional<dds::RawMessage> next(double timeout_s);
  /// From any thread.
  void stop();
  [[nodiscard]] bool stopped() const;

 private:
  static constexpr std::size_t kMaxWaiting = 1000;

  void push(dds::RawMessage message);

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<dds::RawMessage> messages_;
  bool stopped_ = false;
  std::unique_ptr<dds::RawReader> reader_;  // last: it calls push()
};

}  // namespace furrow::cli
