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
#include "outbox.hpp"
#include "realtime_clock.hpp"
#include "strand_queue.hpp"
#include "thread_scheduling.hpp"

namespace furrow::graph {
namespace {

/// Its next call takes no longer than it takes until another thread has been woken for it.
bool is_short(const Node& node) {
  constexpr double kWakeUp_s = 50e-6;
  return node.expected_call_s() < kWakeUp_s;
}

/// Calls nodes from a pool of threads as their mail and timers come; a node is on one thread at a
/// time. Nodes that ask for it have a thread of their own. To wake a thread is what costs most
/// (docs/decisions/0008): a worker goes on with what its callback published, and the transport's
/// thread calls itself who is short.
class RealtimeExecutor final : public Executor {
 public:
  RealtimeExecutor(int threads, Transport* transport) : threads_(threads), transport_(transport) {}

  [[nodiscard]] Time now() const override { return clock_.now(); }

  void publish(Node& from, Route& route, MessagePtr message) override {
    if (!running_) {
      constructed_.push_back({&route, std::move(message)});
      return;
    }
    // A thread of its own may have a priority: it goes on with no reader, and sends nothing itself.
    const bool by_pool = !dedicated_.contains(&from);
    for (const Route::Reader& reader : route.readers) {
      reader.node->push(reader.input, message);
      if (wake_dedicated(*reader.node)) continue;
      std::unique_lock lock(mutex_);
      ready_.enqueue(*reader.node);
      if (!by_pool) unlock_and_wake(lock);
    }
    if (!wanted_outside(route)) return;
    if (by_pool) {
      outbox_.put(route, std::move(message));
    } else {
      route.writer->write(std::move(message));
    }
  }

  void request_stop(std::string_view reason, bool failed) override {
    stop_.set(reason, failed);
    {
      const std::lock_guard lock(timer_mutex_);
      wake_timers_.notify_all();
    }
    const std::lock_guard lock(mutex_);
    wake_workers_.notify_all();
    for (auto& [node, thread] : dedicated_) thread->wake();
  }

  void deliver_from_transport(const Route::Reader& reader, MessagePtr message) override {
    Node& node = *reader.node;
    node.push(reader.input, std::move(message));
    if (!running_ || wake_dedicated(node)) return;
    std::unique_lock lock(mutex_);
    if (stop_.requested()) return;
    // Nothing may hold that thread up where it brings messages to a thread that must be in time.
    if (!dedicated_.empty() || !is_short(node)) {
      ready_.enqueue(node);
    } else if (ready_.begin_or_enqueue(node)) {
      call_on_thread_of_transport(node, lock);
    }
    unlock_and_wake(lock);
  }

  void every_second(std::function<void(Time)> callback) override {
    each_second_ = std::move(callback);
  }

  RunResult run(std::span<const std::unique_ptr<Node>> nodes) override {
    prepare(nodes);
    std::vector<std::thread> workers;
    workers.reserve(static_cast<std::size_t>(threads_));
    for (int i = 0; i < threads_; ++i) workers.emplace_back([this] { work(); });
    for (auto& [node, thread] : dedicated_) thread->start();
    start_timers(nodes);
    if (each_second_) timer_queue_.push({now() + kSecond, nullptr, 0});
    running_ = true;
    for (auto& [route, message] : constructed_) {
      for (const Route::Reader& reader : route->readers) reader.node->push(reader.input, message);
      write_to_transport(*route, message);
    }
    constructed_.clear();
    for (const auto& node : nodes) {
      if (node->has_messages()) schedule(*node);
    }
    for (auto& [node, thread] : dedicated_) thread->release();
    watch_timers();
    for (std::thread& worker : workers) worker.join();
    for (auto& [node, thread] : dedicated_) thread->join();
    wait_for_thread_of_transport();
    outbox_.hand_over();
    running_ = false;
    return stop_.result(now());
  }

 private:
  static constexpr Duration kSecond = Duration::milliseconds(1000);

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
        ready_.add(*node);
      }
    }
  }

  /// When every thread is there: making them takes its time, the more with locked memory.
  void start_timers(std::span<const std::unique_ptr<Node>> nodes) {
    const Time start = now();
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

  bool wake_dedicated(Node& node) {
    const auto own = dedicated_.find(&node);
    if (own == dedicated_.end()) return false;
    own->second->wake();
    return true;
  }

  void schedule(Node& node) {
    if (wake_dedicated(node)) return;
    std::unique_lock lock(mutex_);
    ready_.enqueue(node);
    unlock_and_wake(lock);
  }

  /// A worker for each node that is ready. The mutex is given back first: a thread can be awake
  /// before the call that wakes it has returned, and would find it taken.
  void unlock_and_wake(std::unique_lock<std::mutex>& lock) {
    const int wanted = std::min(static_cast<int>(ready_.size()), idle_);
    const int woken = std::max(0, wanted - waking_);
    waking_ += woken;
    lock.unlock();
    for (int i = 0; i < woken; ++i) wake_workers_.notify_one();
  }

  void call_on_thread_of_transport(Node& node, std::unique_lock<std::mutex>& lock) {
    ++calls_of_transport_;
    lock.unlock();
    node.run_messages();
    leave_wire_to_senders();
    lock.lock();
    ready_.end(node);
    --calls_of_transport_;
    call_of_transport_ended_.notify_all();
  }

  void wait_for_thread_of_transport() {
    std::unique_lock lock(mutex_);
    call_of_transport_ended_.wait(lock, [this] { return calls_of_transport_ == 0; });
  }

  void work() {
    std::unique_lock lock(mutex_);
    bool quick = false;
    while (!stop_.requested()) {
      // A short call comes before waking anybody for what waits besides, but not two in a row.
      quick = !quick && !ready_.empty() && is_short(ready_.front());
      if (!quick && something_waits()) see_to_wire(lock);
      if (ready_.empty()) {
        await_work(lock);
        continue;
      }
      const StrandQueue::Call call = ready_.begin_first();
      if (quick) {
        lock.unlock();
      } else {
        unlock_and_wake(lock);
      }
      run_call(call);
      lock.lock();
      ready_.end(*call.node);
    }
  }

  /// What a callback published waits for nothing but its return: between two of them it is left to
  /// others.
  void run_call(const StrandQueue::Call& call) {
    const auto leave_to_others = [this] {
      std::unique_lock lock(mutex_);
      unlock_and_wake(lock);
      leave_wire_to_senders();
    };
    bool called = call.node->run_messages(leave_to_others) > 0;
    for (const auto& [timer, due] : call.timers) {
      if (std::exchange(called, true)) leave_to_others();
      call.node->run_timer(timer, due);
    }
  }

  [[nodiscard]] bool something_waits() const {
    return transport_ != nullptr && (!outbox_.empty() || transport_->has_waiting());
  }

  void leave_wire_to_senders() {
    if (!something_waits()) return;
    outbox_.hand_over();
    transport_->wake_senders();
  }

  /// What a callback published leaves the process when it has returned: sent here while another
  /// worker is free for what may come. A worker that is waking for a reader inside sees to it too.
  void see_to_wire(std::unique_lock<std::mutex>& lock) {
    if (!ready_.empty() && waking_ > 0) return;
    const bool send_here = ready_.empty() && idle_ > 0;
    lock.unlock();
    if (send_here) {
      outbox_.hand_over();
      transport_->send_one();
    } else {
      leave_wire_to_senders();
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
    while (sleep_until_timer()) {
      TimerEntry entry = timer_queue_.top();
      timer_queue_.pop();
      // A call that came first may take longer than was expected of it.
      leave_wire_to_senders();
      if (entry.node == nullptr) {
        each_second_(now());
        entry.due += kSecond;
      } else {
        std::unique_lock lock(mutex_);
        if (!ready_.enqueue_timer(*entry.node, entry.timer, entry.due)) {
          entry.node->count_missed_timer();
        }
        unlock_and_wake(lock);
        entry.due += entry.node->timers()[entry.timer].period;
      }
      timer_queue_.push(entry);
    }
  }

  /// False: the stop was requested.
  bool sleep_until_timer() {
    std::unique_lock lock(timer_mutex_);
    const auto stopped = [this] { return stop_.requested(); };
    if (timer_queue_.empty()) {
      wake_timers_.wait(lock, stopped);
      return false;
    }
    return !wake_timers_.wait_until(lock, clock_.steady(timer_queue_.top().due), stopped);
  }

  const int threads_;
  Transport* const transport_;
  const RealtimeClock clock_;
  StopRequest stop_;
  std::function<void(Time)> each_second_;
  std::atomic<bool> running_ = false;
  std::vector<std::pair<Route*, MessagePtr>> constructed_;
  std::unordered_map<Node*, std::unique_ptr<DedicatedThread>> dedicated_;  // fixed while running
  Outbox outbox_;

  // The watcher's own while running: with the workers' mutex it would collide with whom it wakes.
  std::priority_queue<TimerEntry, std::vector<TimerEntry>, std::greater<>> timer_queue_;
  std::mutex timer_mutex_;  // of the sleep
  std::condition_variable wake_timers_;

  std::mutex mutex_;  // of what follows
  std::condition_variable wake_workers_;
  std::condition_variable call_of_transport_ended_;
  StrandQueue ready_;
  int idle_ = 0;    ///< workers without work
  int waking_ = 0;  ///< of these, those that were notified
  int calls_of_transport_ = 0;
};

}  // namespace

std::unique_ptr<Executor> make_realtime_executor(int threads, Transport* transport) {
  return std::make_unique<RealtimeExecutor>(threads, transport);
}

}  // namespace furrow::graph
