#include <chrono>
#include <condition_variable>
#include <mutex>
#include <queue>
#include <thread>
#include <unordered_map>

#include "executor.hpp"

namespace furrow::graph {
namespace {

using Steady = std::chrono::steady_clock;

/// Calls nodes from a pool of threads as their mail and timers come; a node is on one thread at a
/// time. Time is Unix time at the start plus what the monotonic clock counted since.
class RealtimeExecutor final : public Executor {
 public:
  explicit RealtimeExecutor(int threads)
      : threads_(threads),
        unix_start_(Time::from_nanoseconds(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                               std::chrono::system_clock::now().time_since_epoch())
                                               .count())),
        steady_start_(Steady::now()) {}

  [[nodiscard]] Time now() const override {
    const auto since = Steady::now() - steady_start_;
    return unix_start_ + Duration::nanoseconds(
                             std::chrono::duration_cast<std::chrono::nanoseconds>(since).count());
  }

  void publish(Node& /*from*/, Route& route, MessagePtr message) override {
    if (!running_) {
      constructed_.push_back({&route, std::move(message)});
      return;
    }
    deliver(route, message);
  }

  void request_stop(std::string_view reason, bool failed) override {
    stop_.set(reason, failed);
    const std::lock_guard lock(mutex_);
    wake_workers_.notify_all();
    wake_timers_.notify_all();
  }

  void deliver_from_wire(const Route::Reader& reader, MessagePtr message) override {
    reader.node->push(reader.input, std::move(message));
    if (running_) schedule(*reader.node);
  }

  RunResult run(std::span<const std::unique_ptr<Node>> nodes) override {
    for (const auto& node : nodes) strands_.emplace(node.get(), Strand{});
    const Time start = now();
    for (const auto& node : nodes) {
      auto& timers = node->timers();
      for (std::size_t i = 0; i < timers.size(); ++i) {
        timers[i].next = start + timers[i].period;
        timer_queue_.push({timers[i].next, node.get(), i});
      }
      strands_.at(node.get()).timer_pending.assign(timers.size(), false);
    }
    running_ = true;
    for (auto& [route, message] : constructed_) deliver(*route, message);
    constructed_.clear();
    for (const auto& node : nodes) {
      if (node->has_messages()) schedule(*node);
    }
    std::vector<std::thread> workers;
    for (int i = 0; i < threads_; ++i) workers.emplace_back([this] { work(); });
    watch_timers();
    for (std::thread& worker : workers) worker.join();
    running_ = false;
    return stop_.result(now());
  }

 private:
  struct Strand {
    bool queued = false;
    bool again = false;  // something came while it ran
    bool running = false;
    std::vector<bool> timer_pending;
    std::vector<std::pair<std::size_t, Time>> due;
  };
  struct TimerEntry {
    Time due;
    Node* node;
    std::size_t timer;
    bool operator>(const TimerEntry& other) const { return due > other.due; }
  };

  void deliver(Route& route, const MessagePtr& message) {
    for (const Route::Reader& reader : route.readers) {
      reader.node->push(reader.input, message);
      schedule(*reader.node);
    }
    write_to_wire(route, message);
  }

  void schedule(Node& node) {
    const std::lock_guard lock(mutex_);
    enqueue(node);
  }

  // With the mutex held.
  void enqueue(Node& node) {
    Strand& strand = strands_.at(&node);
    if (strand.running) {
      strand.again = true;
    } else if (!strand.queued) {
      strand.queued = true;
      ready_.push(&node);
      wake_workers_.notify_one();
    }
  }

  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      wake_workers_.wait(lock, [this] { return stop_.requested() || !ready_.empty(); });
      if (stop_.requested()) return;
      Node& node = *ready_.front();
      ready_.pop();
      Strand& strand = strands_.at(&node);
      strand.queued = false;
      strand.running = true;
      strand.again = false;
      const auto due = std::exchange(strand.due, {});
      for (const auto& [timer, time] : due) strand.timer_pending[timer] = false;
      lock.unlock();
      node.run_messages();
      for (const auto& [timer, time] : due) node.run_timer(timer, time);
      lock.lock();
      strand.running = false;
      if (strand.again || node.has_messages()) enqueue(node);
    }
  }

  void watch_timers() {
    std::unique_lock lock(mutex_);
    while (!stop_.requested()) {
      if (timer_queue_.empty()) {
        wake_timers_.wait(lock, [this] { return stop_.requested(); });
        return;
      }
      TimerEntry entry = timer_queue_.top();
      const auto due =
          steady_start_ + std::chrono::nanoseconds((entry.due - unix_start_).count_ns());
      if (wake_timers_.wait_until(lock, due, [this] { return stop_.requested(); })) return;
      timer_queue_.pop();
      Strand& strand = strands_.at(entry.node);
      if (strand.timer_pending[entry.timer]) {
        entry.node->count_missed_timer();
      } else {
        strand.timer_pending[entry.timer] = true;
        strand.due.emplace_back(entry.timer, entry.due);
        enqueue(*entry.node);
      }
      entry.due += entry.node->timers()[entry.timer].period;
      timer_queue_.push(entry);
    }
  }

  const int threads_;
  const Time unix_start_;
  const Steady::time_point steady_start_;
  StopRequest stop_;
  std::atomic<bool> running_ = false;
  std::vector<std::pair<Route*, MessagePtr>> constructed_;

  std::mutex mutex_;  // of what follows
  std::condition_variable wake_workers_;
  std::condition_variable wake_timers_;
  std::unordered_map<Node*, Strand> strands_;
  std::queue<Node*> ready_;
  std::priority_queue<TimerEntry, std::vector<TimerEntry>, std::greater<>> timer_queue_;
};

}  // namespace

std::unique_ptr<Executor> make_realtime_executor(int threads) {
  return std::make_unique<RealtimeExecutor>(threads);
}

}  // namespace furrow::graph
