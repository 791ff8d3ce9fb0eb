#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "executor.hpp"

namespace furrow::graph {
namespace {

/// Calls `work(i)` for every i of a range, on this thread and some others, and returns when all are
/// done.
class Crew {
 public:
  explicit Crew(int threads) {
    for (int i = 1; i < threads; ++i) helpers_.emplace_back([this] { help(); });
  }
  ~Crew() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
    }
    wake_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }

  void run(std::size_t count, const std::function<void(std::size_t)>& work) {
    if (count == 1 || helpers_.empty()) {
      for (std::size_t i = 0; i < count; ++i) work(i);
      return;
    }
    {
      const std::lock_guard lock(mutex_);
      work_ = &work;
      next_ = 0;
      count_ = count;
      left_ = count;
    }
    wake_.notify_all();
    std::unique_lock lock(mutex_);
    take(lock);
    done_.wait(lock, [this] { return left_ == 0; });
    work_ = nullptr;
  }

 private:
  void take(std::unique_lock<std::mutex>& lock) {
    while (work_ != nullptr && next_ < count_) {
      const std::size_t mine = next_++;
      const auto* work = work_;
      lock.unlock();
      (*work)(mine);
      lock.lock();
      if (--left_ == 0) done_.notify_one();
    }
  }

  void help() {
    std::unique_lock lock(mutex_);
    while (!quit_) {
      take(lock);
      if (quit_) break;
      wake_.wait(lock, [this] { return quit_ || (work_ != nullptr && next_ < count_); });
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  const std::function<void(std::size_t)>* work_ = nullptr;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  std::size_t left_ = 0;
  bool quit_ = false;
  std::vector<std::thread> helpers_;
};

/// Steps simulated time from one due timer to the next. At an instant the nodes run in waves: those
/// with mail or a due timer run side by side, then what they published is delivered in the order of
/// the graph. So the outcome does not depend on the number of threads.
class LockstepExecutor final : public Executor {
 public:
  explicit LockstepExecutor(int threads) : crew_(threads) {}

  [[nodiscard]] Time now() const override { return now_; }

  void publish(Node& from, Route& route, MessagePtr message) override {
    // Constructors run one after another, before the outboxes are known.
    auto& outbox = running_ ? outbox_of(from) : constructed_;
    outbox.push_back({&route, std::move(message)});
  }

  void request_stop(std::string_view reason, bool failed) override { stop_.set(reason, failed); }

  void deliver_from_wire(const Route::Reader& reader, MessagePtr message) override {
    const std::lock_guard lock(wire_mutex_);
    from_wire_.push_back({reader, std::move(message)});
  }

  RunResult run(std::span<const std::unique_ptr<Node>> nodes) override {
    nodes_ = nodes;
    outboxes_.resize(nodes.size());
    running_ = true;
    deliver(constructed_);
    for (const auto& node : nodes) {
      for (Node::Timer& timer : node->timers()) timer.next = now_ + timer.period;
    }
    while (!stop_.requested()) {
      run_instant();
      if (stop_.requested()) break;
      const Time next = next_timer();
      if (next == kNever) {
        stop_.set("nothing is left to do", false);
        break;
      }
      now_ = next;
    }
    return stop_.result(now_);
  }

 private:
  struct Published {
    Route* route;
    MessagePtr message;
  };
  static constexpr Time kNever = Time::from_nanoseconds(INT64_MAX);

  std::vector<Published>& outbox_of(const Node& node) {
    const auto it = std::ranges::find(nodes_, &node, &std::unique_ptr<Node>::get);
    return outboxes_[static_cast<std::size_t>(it - nodes_.begin())];
  }

  void run_instant() {
    while (!stop_.requested()) {
      take_from_wire();
      ready_.clear();
      for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (nodes_[i]->has_messages() || timer_due(*nodes_[i])) ready_.push_back(i);
      }
      if (ready_.empty()) return;
      crew_.run(ready_.size(), [this](std::size_t k) { run_node(*nodes_[ready_[k]]); });
      for (const std::size_t i : ready_) deliver(outboxes_[i]);
    }
  }

  [[nodiscard]] bool timer_due(Node& node) const {
    return std::ranges::any_of(node.timers(),
                               [this](const Node::Timer& timer) { return timer.next <= now_; });
  }

  void run_node(Node& node) {
    node.run_messages();
    for (std::size_t i = 0; i < node.timers().size(); ++i) {
      Node::Timer& timer = node.timers()[i];
      if (timer.next > now_) continue;
      timer.next += timer.period;
      node.run_timer(i, now_);
    }
  }

  void deliver(std::vector<Published>& outbox) {
    for (Published& published : outbox) {
      for (const Route::Reader& reader : published.route->readers) {
        reader.node->push(reader.input, published.message);
      }
      write_to_wire(*published.route, published.message);
    }
    outbox.clear();
  }

  void take_from_wire() {
    const std::lock_guard lock(wire_mutex_);
    for (auto& [reader, message] : from_wire_) reader.node->push(reader.input, std::move(message));
    from_wire_.clear();
  }

  [[nodiscard]] Time next_timer() const {
    Time next = kNever;
    for (const auto& node : nodes_) {
      for (const Node::Timer& timer : node->timers()) next = std::min(next, timer.next);
    }
    return next;
  }

  Crew crew_;
  StopRequest stop_;
  Time now_;
  bool running_ = false;
  std::span<const std::unique_ptr<Node>> nodes_;
  std::vector<std::vector<Published>> outboxes_;
  std::vector<Published> constructed_;
  std::vector<std::size_t> ready_;
  std::mutex wire_mutex_;
  std::vector<std::pair<Route::Reader, MessagePtr>> from_wire_;
};

}  // namespace

std::unique_ptr<Executor> make_lockstep_executor(int threads) {
  return std::make_unique<LockstepExecutor>(threads);
}

void write_to_wire(Route& route, const MessagePtr& message) {
  if (route.wire == nullptr) return;
  if (route.qos.durability == msgs::Durability::kTransientLocal || route.wire->has_readers()) {
    route.wire->write(message);
  }
}

void StopRequest::set(std::string_view reason, bool failed) {
  const std::lock_guard lock(mutex_);
  if (requested_) return;
  reason_ = reason;
  failed_ = failed;
  requested_ = true;
}

RunResult StopRequest::result(Time end) const {
  const std::lock_guard lock(mutex_);
  return {reason_, failed_, end};
}

}  // namespace furrow::graph
