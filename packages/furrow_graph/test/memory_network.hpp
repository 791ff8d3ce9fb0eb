#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "furrow_core/random.hpp"
#include "furrow_graph/transport.hpp"

namespace furrow::graph::test {

/// A network in memory: a thread of the network delivers messages in CDR form. Messages of
/// different writers overtake each other at random by `seed`; those of one writer do not. Late
/// readers get the messages of latched writers.
class MemoryNetwork {
 public:
  explicit MemoryNetwork(std::uint64_t seed) : random_(seed), thread_([this] { carry(); }) {}
  ~MemoryNetwork() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }

  /// The transport of one process.
  class Endpoint final : public Transport {
   public:
    Endpoint(MemoryNetwork& network, int process) : network_(network), process_(process) {}
    [[nodiscard]] std::unique_ptr<TransportWriter> make_writer(const std::string& topic,
                                                               const msgs::MessageType& type,
                                                               const msgs::Qos& qos) override {
      return std::make_unique<Writer>(network_, process_, topic, type, qos);
    }
    [[nodiscard]] std::unique_ptr<TransportReader> make_reader(
        const std::string& topic, const msgs::MessageType& type, const msgs::Qos& /*qos*/,
        std::function<void(MessagePtr)> on_message) override {
      return std::make_unique<Reader>(network_, process_, topic, type, std::move(on_message));
    }

   private:
    MemoryNetwork& network_;
    int process_;
  };

 private:
  using Bytes = std::shared_ptr<const std::vector<std::byte>>;

  struct Reader final : TransportReader {
    Reader(MemoryNetwork& network, int in_process, std::string name,
           const msgs::MessageType& of_type, std::function<void(MessagePtr)> call)
        : owner(network),
          process(in_process),
          topic(std::move(name)),
          type(of_type),
          on_message(std::move(call)) {
      const std::lock_guard lock(owner.mutex_);
      owner.readers_.insert(this);
      for (const auto& [writer, kept] : owner.kept_) {
        if (writer->topic != topic || writer->process == process) continue;
        for (const Bytes& bytes : kept) owner.pending_[{writer, this}].push_back(bytes);
      }
      owner.wake_.notify_all();
    }
    ~Reader() override {
      std::unique_lock lock(owner.mutex_);
      owner.readers_.erase(this);
      std::erase_if(owner.pending_, [this](const auto& e) { return e.first.second == this; });
      owner.idle_.wait(lock, [this] { return owner.calling_ != this; });
    }
    [[nodiscard]] TransportCounters counters() const override { return {}; }
    [[nodiscard]] int writers() const override {
      const std::lock_guard lock(owner.mutex_);
      int count = 0;
      for (const auto& [writer, kept] : owner.kept_) {
        count += writer->topic == topic && writer->process != process ? 1 : 0;
      }
      return count;
    }
    MemoryNetwork& owner;
    int process;
    std::string topic;
    const msgs::MessageType& type;
    std::function<void(MessagePtr)> on_message;
  };

  struct Writer final : TransportWriter {
    Writer(MemoryNetwork& network, int in_process, std::string name,
           const msgs::MessageType& of_type, const msgs::Qos& of_qos)
        : owner(network), process(in_process), topic(std::move(name)), type(of_type), qos(of_qos) {
      const std::lock_guard lock(owner.mutex_);
      owner.kept_[this];
    }
    ~Writer() override {
      const std::lock_guard lock(owner.mutex_);
      owner.kept_.erase(this);
    }
    [[nodiscard]] bool has_readers() const override {
      const std::lock_guard lock(owner.mutex_);
      for (const Reader* reader : owner.readers_) {
        if (reader->topic == topic && reader->process != process) return true;
      }
      return false;
    }
    void write(MessagePtr message) override {
      std::vector<std::byte> bytes(type.serialized_size(message.get()));
      (void)type.serialize(message.get(), bytes);
      const auto sent = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
      const std::lock_guard lock(owner.mutex_);
      if (qos.durability == msgs::Durability::kTransientLocal) {
        auto& kept = owner.kept_[this];
        kept.push_back(sent);
        if (kept.size() > static_cast<std::size_t>(qos.depth)) kept.pop_front();
      }
      for (Reader* reader : owner.readers_) {
        if (reader->topic == topic && reader->process != process) {
          owner.pending_[{this, reader}].push_back(sent);
        }
      }
      owner.wake_.notify_all();
    }
    [[nodiscard]] TransportCounters counters() const override { return {}; }
    MemoryNetwork& owner;
    int process;
    std::string topic;
    const msgs::MessageType& type;
    msgs::Qos qos;
  };

  void carry() {
    std::unique_lock lock(mutex_);
    while (true) {
      wake_.wait(lock, [this] { return quit_ || !pending_.empty(); });
      if (quit_) return;
      auto next = pending_.begin();
      const auto count = static_cast<std::int64_t>(pending_.size());
      std::advance(next, random_.integer(0, count - 1));
      Reader* reader = next->first.second;
      const Bytes bytes = std::move(next->second.front());
      next->second.pop_front();
      if (next->second.empty()) pending_.erase(next);
      calling_ = reader;
      lock.unlock();
      const std::shared_ptr<void> message = reader->type.create();
      if (reader->type.deserialize(*bytes, message.get()).ok()) reader->on_message(message);
      lock.lock();
      calling_ = nullptr;
      idle_.notify_all();
    }
  }

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable idle_;
  Random random_;
  std::set<Reader*> readers_;
  std::map<Writer*, std::deque<Bytes>> kept_;
  std::map<std::pair<Writer*, Reader*>, std::deque<Bytes>> pending_;
  Reader* calling_ = nullptr;
  bool quit_ = false;
  std::thread thread_;
};

}  // namespace furrow::graph::test
