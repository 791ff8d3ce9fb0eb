#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "furrow_dds/dds_transport.hpp"
#include "furrow_dds/test_domain.hpp"
#include "furrow_msgs/message_types.hpp"
#include "furrow_msgs/sensor_msgs.h"
#include "furrow_msgs/std_msgs.h"

namespace furrow::dds {

inline constexpr std::chrono::seconds kPatience{5};

inline DdsParameters test_parameters(const std::string& name,
                                     const std::vector<std::string>& transports = {"shm", "udp"}) {
  DdsParameters parameters;
  parameters.domain_id = test_domain();
  parameters.process_name = name;
  parameters.transports = transports;
  parameters.shm_segment_mb = 16;
  return parameters;
}

/// Polls `condition`, for changes without an event: matches and counters.
inline bool eventually(const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  std::mutex mutex;
  std::condition_variable never;
  std::unique_lock lock(mutex);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) {
      return false;
    }
    never.wait_for(lock, std::chrono::milliseconds(2));
  }
  return true;
}

/// The messages that a reader received, in order.
template <class T>
class Inbox {
 public:
  void put(T item) {
    const std::lock_guard lock(mutex_);
    items_.push_back(std::move(item));
    arrived_.notify_all();
  }
  [[nodiscard]] bool wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    return arrived_.wait_for(lock, kPatience, [&] { return items_.size() >= count; });
  }
  [[nodiscard]] std::vector<T> items() const {
    const std::lock_guard lock(mutex_);
    return {items_.begin(), items_.end()};
  }
  [[nodiscard]] std::size_t size() const { return items().size(); }

 private:
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::deque<T> items_;
};

using StringMessage = std_msgs::msg::String;
using Image = sensor_msgs::msg::Image;

class StringInbox : public Inbox<std::string> {
 public:
  [[nodiscard]] std::function<void(graph::MessagePtr)> handler() {
    return [this](const graph::MessagePtr& message) {
      put(static_cast<const StringMessage*>(message.get())->data());
    };
  }
};

inline graph::MessagePtr make_string(const std::string& text) {
  auto message = std::make_shared<StringMessage>();
  message->data(text);
  return message;
}

inline const msgs::MessageType& string_type() {
  return msgs::message_type<StringMessage>();
}
inline const msgs::MessageType& image_type() {
  return msgs::message_type<Image>();
}

inline msgs::Qos watched_qos() {
  msgs::Qos qos = msgs::event_qos();
  qos.liveliness_lease = Duration::milliseconds(200);
  return qos;
}

/// Two processes of one domain.
class TwoProcesses : public ::testing::Test {
 protected:
  DdsTransport a_{test_parameters("a")};
  DdsTransport b_{test_parameters("b")};
};

/// An image of `bytes` with random content by `seed`.
inline std::shared_ptr<const Image> make_image(std::size_t bytes, std::uint32_t seed) {
  auto image = std::make_shared<Image>();
  image->height(1);
  image->width(static_cast<std::uint32_t>(bytes));
  image->encoding("mono8");
  image->data().resize(bytes);
  std::uint32_t state = seed * 2654435761U + 1U;
  for (auto& byte : image->data()) {
    state = state * 1664525U + 1013904223U;
    byte = static_cast<std::uint8_t>(state >> 24U);
  }
  return image;
}

}  // namespace furrow::dds
