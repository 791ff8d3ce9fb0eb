#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "furrow_core/mutex.hpp"
#include "furrow_graph/transport.hpp"

namespace furrow::graph::test {

/// Records the written messages. The test delivers messages of other processes, and is then the
/// receive thread.
class FakeTransport final : public Transport {
 public:
  std::unique_ptr<TransportWriter> make_writer(const std::string& topic, const msgs::MessageType&,
                                               const msgs::Qos&) override {
    return std::make_unique<Writer>(*this, topic);
  }
  std::unique_ptr<TransportReader> make_reader(
      const std::string& topic, const msgs::MessageType&, const msgs::Qos&,
      std::function<void(MessagePtr)> on_message) override {
    receivers[topic] = std::move(on_message);
    return std::make_unique<Reader>();
  }

  [[nodiscard]] std::vector<MessagePtr> written(const std::string& topic) {
    const MutexLock lock(mutex_);
    return written_[topic];
  }
  /// False after 5 s.
  [[nodiscard]] bool wait_written(const std::string& topic, std::size_t count) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    const MutexLock lock(mutex_);
    while (written_[topic].size() < count) {
      if (!changed_.wait_until(mutex_, deadline)) return false;
    }
    return true;
  }

  std::atomic<bool> has_external_subscribers = true;                 ///< of every topic
  std::map<std::string, std::function<void(MessagePtr)>> receivers;  ///< by topic

 private:
  struct Writer final : TransportWriter {
    Writer(FakeTransport& transport, std::string name) : owner(transport), topic(std::move(name)) {}
    [[nodiscard]] bool has_readers() const override { return owner.has_external_subscribers; }
    void write(MessagePtr message) override {
      const MutexLock lock(owner.mutex_);
      owner.written_[topic].push_back(std::move(message));
      owner.changed_.notify_all();
    }
    [[nodiscard]] TransportCounters counters() const override { return {}; }
    FakeTransport& owner;
    const std::string topic;
  };
  struct Reader final : TransportReader {
    [[nodiscard]] TransportCounters counters() const override { return {}; }
    [[nodiscard]] int writers() const override { return 0; }
  };

  Mutex mutex_;
  ConditionVariable changed_;
  std::map<std::string, std::vector<MessagePtr>> written_ FURROW_GUARDED_BY(mutex_);
};

}  // namespace furrow::graph::test
