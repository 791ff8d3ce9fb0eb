#include <algorithm>
#include <atomic>
#include <memory>
#include <queue>
#include <system_error>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "dedicated_thread.hpp"
#include "executor.hpp"
#include "ready_queue.hpp"
#include "realtime_clock.hpp"
#include "stop_request.hpp"
#include "thread_scheduling.hpp"

namespace furrow::graph {
namespace {

/// Calls nodes by the computer's clock.
/// - publish() puts the message into the mailbox of each reader and the reader into the ready
///   queue, which wakes an idle worker. Then it puts the message into the topic's send queue, which
///   wakes the sender of the transport.
/// - A worker takes the first ready node, runs its callbacks, and takes the next.
/// - The thread of run() sleeps until the next timer is due and makes its node ready.
/// - A node with a dedicated thread is called by that thread only.
/// - The receive threads of the transport only fill mailboxes.
class RealtimeExecutor final : public Executor {
 public:
  explicit RealtimeExecutor(int threads) : threads_(threads) {}

  [[nodiscard]] Time now() const override { return clock_.now(); }

  void publish(Node& /*from*/, Route& route, MessagePtr message) override {
    if (running_) {
      deliver(route, message);
    } else {
      constructed_.push_back({&route, std::move(message)});
    }
  }

  void request_stop(std::string_view reason, bool failed) override {
    stop_.set(reason, failed);  // ends serve_timers(), after which run() wakes dedicated threads
    ready_.close();
  }

  void deliver_from_transport(const Route::Reader& reader, MessagePtr message) override {
    reader.node->push(reader.input, std::move(message));
    if (running_) wake(*reader.node);
  }

  RunResult run(std::span<const std::unique_ptr<Node>> nodes) override {
    prepare(nodes);
    std::vector<std::thread> workers;
    start_threads(workers);
    start_timers(nodes);
    running_ = true;
    for (const auto& [route, message] : constructed_) deliver(*route, message);
    constructed_.clear();
    for (const auto& node : nodes) {
      if (node->has_messages()) wake(*node);
    }
    for (auto& [node, thread] : dedicated_) thread->release();
    serve_timers();
    for (std::thread& worker : workers) worker.join();
    for (auto& [node, thread] : dedicated_) {
      thread->wake();
      thread->join();
    }
    running_ = false;
    return stop_.result(now());
  }

 private:
  static constexpr Duration kSecond = Duration::milliseconds(1000);

  struct TimerEntry {
    Time due;
    Node* node;  ///< null: every_second()
    std::size_t timer;
    bool operator>(const TimerEntry& other) const { return due > other.due; }
  };

  void prepare(std::span<const std::unique_ptr<Node>> nodes) {
    lock_memory_for(nodes);
    for (const auto& node : nodes) {
      if (node->spec().dedicated_thread) {
        dedicated_.emplace(node.get(), std::make_unique<DedicatedThread>(*node, clock_, stop_));
      } else {
        ready_.add(*node);
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

  void start_threads(std::vector<std::thread>& workers) {
    workers.reserve(static_cast<std::size_t>(threads_));
    try {
      for (int i = 0; i < threads_; ++i) workers.emplace_back([this] { work(); });
      for (auto& [node, thread] : dedicated_) thread->start();
    } catch (const std::system_error& error) {
      request_stop(std::string("a thread cannot be started: ") + error.what(), true);
    }
  }

  /// After start_threads(), which takes its time, the more with locked memory.
  void start_timers(std::span<const std::unique_ptr<Node>> nodes) {
    const Time start = now();
    for (const auto& node : nodes) {
      for (std::size_t i = 0; i < node->timers().size(); ++i) {
        Node::Timer& timer = node->timers()[i];
        timer.next = start + timer.period;
        if (!node->spec().dedicated_thread) timer_queue_.push({timer.next, node.get(), i});
      }
    }
    if (each_second_) timer_queue_.push({start + kSecond, nullptr, 0});
  }

  void deliver(const Route& route, const MessagePtr& message) {
    for (const Route::Reader& reader : route.readers) {
      reader.node->push(reader.input, message);
      wake(*reader.node);
    }
    route.write_to_transport(message);
  }

  void wake(Node& node) {
    const auto own = dedicated_.find(&node);
    if (own == dedicated_.end()) {
      ready_.push(node);
    } else {
      own->second->wake();
    }
  }

  void work() {
    while (const auto call = ready_.pop()) {
      call->node->run_messages();
      for (const auto& [timer, due] : call->timers) call->node->run_timer(timer, due);
      ready_.done(*call->node);
    }
  }

  /// Returns when a stop is requested.
  void serve_timers() {
    while (!timer_queue_.empty()) {
      TimerEntry entry = timer_queue_.top();
      if (stop_.wait_until(clock_.steady(entry.due))) return;
      timer_queue_.pop();
      if (entry.node == nullptr) {
        each_second_(now());
        entry.due += kSecond;
      } else {
        if (!ready_.push_timer(*entry.node, entry.timer, entry.due)) {
          entry.node->count_missed_timer();
        }
        entry.due += entry.node->timers()[entry.timer].period;
      }
      timer_queue_.push(entry);
    }
    stop_.wait();
  }

  const int threads_;
  const RealtimeClock clock_;
  StopRequest stop_;
  ReadyQueue ready_;
  std::atomic<bool> running_ = false;
  std::vector<std::pair<Route*, MessagePtr>> constructed_;
  std::unordered_map<Node*, std::unique_ptr<DedicatedThread>> dedicated_;  // fixed while running
  // Used by the thread of run() only.
  std::priority_queue<TimerEntry, std::vector<TimerEntry>, std::greater<>> timer_queue_;
};

}  // namespace

std::unique_ptr<Executor> make_realtime_executor(int threads) {
  return std::make_unique<RealtimeExecutor>(threads);
}

}  // namespace furrow::graph
