#include <algorithm>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <queue>
#include <thread>
#include <unordered_map>
#include <utility>

#include "dedicated_thread.hpp"
#include "executor.hpp"
#include "realtime_clock.hpp"
#include "thread_scheduling.hpp"

namespace furrow::graph {
namespace {

/// Calls nodes from a pool of threads as their mail and timers come; a node is on one thread at a
/// time. Nodes that ask for it have a thread of their own.
class RealtimeExecutor final : public Executor {
 public:
  RealtimeExecutor(int threads, Transport* transport) : threads_(threads), transport_(transport) {}

  [[nodiscard]] Time now() const override { return clock_.now(); }

  void publish(Node& from, Route& route, MessagePtr message) override {
    if (!running_) {
      constructed_.push_back({&route, std::move(message)});
      return;
    }
    deliver(route, message);
    if (!wanted_outside(route)) return;
    // A thread of its own may have a priority: it sends nothing itself.
    if (dedicated_.contains(&from)) {
      route.wire->write(std::move(message));
    } else {
      route.wire->enqueue(std::move(message));
    }
  }

  void request_stop(std::string_view reason, bool failed) override {
    stop_.set(reason, failed);
    const std::lock_guard lock(mutex_);
    wake_workers_.notify_all();
    wake_timers_.notify_all();
    for (auto& [node, thread] : dedicated_) thread->wake();
  }

  void deliver_from_wire(const Route::Reader& reader, MessagePtr message) override {
    reader.node->push(reader.input, std::move(message));
    if (running_) schedule(*reader.node);
  }

  void every_second(std::function<void(Time)> callback) override {
    each_second_ = std::move(callback);
  }

  RunResult run(std::span<const std::unique_ptr<Node>> nodes) override {
    prepare(nodes);
    std::vector<std::thread> workers;
    for (int i = 0; i < threads_; ++i) workers.emplace_back([this] { work(); });
    for (auto& [node, thread] : dedicated_) thread->start();
    start_timers(nodes);
    if (each_second_) timer_queue_.push({now() + kSecond, nullptr, 0});
    running_ = true;
    for (auto& [route, message] : constructed_) {
      deliver(*route, message);
      write_to_wire(*route, message);
    }
    constructed_.clear();
    for (const auto& node : nodes) {
      if (node->has_messages()) schedule(*node);
    }
    for (auto& [node, thread] : dedicated_) thread->release();
    watch_timers();
    for (std::thread& worker : workers) worker.join();
    for (auto& [node, thread] : dedicated_) thread->join();
    running_ = false;
    return stop_.result(now());
  }

 private:
  static constexpr Duration kSecond = Duration::milliseconds(1000);

  struct Strand {
    bool queued = false;
    bool again = false;  // something came while it ran
    bool running = false;
    std::vector<bool> timer_pending;
    std::vector<std::pair<std::size_t, Time>> due;
  };
  struct TimerEntry {
    Time due;
    Node* node;  ///< null: the second
    std::size_t timer;
    bool operator>(const TimerEntry& other) const { return due > other.due; }
  };

  void prepare(std::span<const std::unique_ptr<Node>> nodes) {
    lock_memory_for(nodes);
    const std::lock_guard lock(mutex_);
    for (const auto& node : nodes) {
      if (node->spec().dedicated_thread) {
        dedicated_.emplace(node.get(), std::make_unique<DedicatedThread>(*node, clock_, stop_));
      } else {
        strands_[node.get()].timer_pending.assign(node->timers().size(), false);
      }
    }
  }

  /// When every thread is there: making them takes its time, the more with locked memory.
  void start_timers(std::span<const std::unique_ptr<Node>> nodes) {
    const Time start = now();
    const std::lock_guard lock(mutex_);
    for (const auto& node : nodes) {
      for (std::size_t i = 0; i < node->timers().size(); ++i) {
        Node::Timer& timer = node->timers()[i];
        timer.next = start + timer.period;
        if (!node->spec().dedicated_thread) timer_queue_.push({timer.next, node.get(), i});
      }
    }
  }

  static void lock_memory_for(std::span<const std::unique_ptr<Node>> nodes) {
    const auto wants = [](const auto& node) { return node->spec().priority > 0; };
    if (std::ranges::none_of(nodes, wants)) return;
    const std::string refused = lock_memory();
    for (const auto& node : nodes) {
      if (wants(node)) node->set_memory(refused.empty() ? "locked" : "not locked: " + refused);
    }
  }

  void deliver(Route& route, const MessagePtr& message) {
    for (const Route::Reader& reader : route.readers) {
      reader.node->push(reader.input, message);
      schedule(*reader.node);
    }
  }

  void schedule(Node& node) {
    if (const auto own = dedicated_.find(&node); own != dedicated_.end()) {
      own->second->wake();
      return;
    }
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
      if (waking_ < idle_) {
        ++waking_;
        wake_workers_.notify_one();
      }
    }
  }

  void work() {
    std::unique_lock lock(mutex_);
    while (!stop_.requested()) {
      if (something_waits()) see_to_wire(lock);
      if (ready_.empty()) {
        await_work(lock);
        continue;
      }
      Node& node = *ready_.front();
      ready_.pop();
      Strand& strand = strands_.at(&node);
      strand.queued = false;
      strand.running = true;
      strand.again = false;
      const auto due = std::exchange(strand.due, {});
      for (const auto& [timer, time] : due) strand.timer_pending[timer] = false;
      lock.unlock();
      const auto leave_wire_to_senders = [this] {
        if (something_waits()) transport_->wake_senders();
      };
      bool called = node.run_messages(leave_wire_to_senders) > 0;
      for (const auto& [timer, time] : due) {
        if (std::exchange(called, true)) leave_wire_to_senders();
        node.run_timer(timer, time);
      }
      lock.lock();
      strand.running = false;
      if (strand.again || node.has_messages()) enqueue(node);
    }
  }

  [[nodiscard]] bool something_waits() const {
    return transport_ != nullptr && transport_->has_waiting();
  }

  /// What a callback published leaves the process when it has returned. Readers inside come first:
  /// where a worker is waking besides, that one sees to the wire. It is sent here while another
  /// worker is free for what may come.
  void see_to_wire(std::unique_lock<std::mutex>& lock) {
    if (!ready_.empty() && waking_ > 0) return;
    const bool send_here = ready_.empty() && idle_ > 0;
    lock.unlock();
    if (send_here) {
      transport_->send_one();
    } else {
      transport_->wake_senders();
    }
    lock.lock();
  }

  void await_work(std::unique_lock<std::mutex>& lock) {
    ++idle_;
    wake_workers_.wait(lock, [this] { return stop_.requested() || waking_ > 0; });
    --idle_;
    if (waking_ > 0) --waking_;
  }

  void watch_timers() {
    std::unique_lock lock(mutex_);
    while (!stop_.requested()) {
      if (timer_queue_.empty()) {
        wake_timers_.wait(lock, [this] { return stop_.requested(); });
        return;
      }
      TimerEntry entry = timer_queue_.top();
      const auto due = clock_.steady(entry.due);
      if (wake_timers_.wait_until(lock, due, [this] { return stop_.requested(); })) return;
      timer_queue_.pop();
      if (entry.node == nullptr) {
        timer_queue_.push({entry.due + kSecond, nullptr, 0});
        lock.unlock();
        each_second_(now());
        lock.lock();
        continue;
      }
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
  Transport* const transport_;
  const RealtimeClock clock_;
  StopRequest stop_;
  std::function<void(Time)> each_second_;
  std::atomic<bool> running_ = false;
  std::vector<std::pair<Route*, MessagePtr>> constructed_;
  std::unordered_map<Node*, std::unique_ptr<DedicatedThread>> dedicated_;  // fixed while running

  std::mutex mutex_;  // of what follows
  std::condition_variable wake_workers_;
  std::condition_variable wake_timers_;
  std::unordered_map<Node*, Strand> strands_;
  std::queue<Node*> ready_;
  int idle_ = 0;    ///< workers without work
  int waking_ = 0;  ///< of these, those that were notified
  std::priority_queue<TimerEntry, std::vector<TimerEntry>, std::greater<>> timer_queue_;
};

}  // namespace

std::unique_ptr<Executor> make_realtime_executor(int threads, Transport* transport) {
  return std::make_unique<RealtimeExecutor>(threads, transport);
}

}  // namespace furrow::graph
