#include <algorithm>
#include <atomic>
#include <span>

#include "executor.hpp"
#include "stop_request.hpp"
#include "worker_pool.hpp"

namespace furrow::graph {
namespace {

/// Advances simulated time from one due timer to the next. At each instant it runs simulation
/// steps: all nodes with messages or a due timer run in parallel. Then their messages are delivered
/// in the order of the graph. So the outcome does not depend on the number of threads.
class LockstepExecutor final : public Executor {
 public:
  explicit LockstepExecutor(int threads) : workers_(threads) {}

  [[nodiscard]] Time now() const override { return now_; }

  void publish(Node& from, Route& route, MessagePtr message) override {
    // Constructors run one after another, before the nodes have outboxes.
    auto& outbox = running_ ? outboxes_[index_of(from)] : constructed_;
    outbox.push_back({&from, &route, std::move(message)});
  }

  void request_stop(std::string_view reason, bool failed) override { stop_.set(reason, failed); }

  void interrupt(std::string_view reason) override {
    interrupted_ = true;
    stop_.set(reason, false);
    if (shared_ != nullptr) shared_->exchange->abort(std::string(reason));
  }

  void share(std::unique_ptr<SharedLockstep> shared) override { shared_ = std::move(shared); }

  void deliver_from_transport(const Route::Reader& reader, MessagePtr message) override {
    const MutexLock lock(transport_mutex_);
    from_transport_.push_back({reader, std::move(message)});
  }

  RunResult run(std::span<const std::unique_ptr<Node>> nodes) override {
    nodes_ = nodes;
    outboxes_.resize(nodes.size());
    running_ = true;
    for (const auto& node : nodes) {
      for (Node::Timer& timer : node->timers()) timer.next = now_ + timer.period;
    }
    return shared_ == nullptr ? run_alone() : run_shared();
  }

 private:
  struct Published {
    Node* from;
    Route* route;
    MessagePtr message;
  };
  /// A message for the inputs of this process, with the keys of its place in the order.
  struct Delivery {
    std::uint32_t component;
    std::uint32_t topic;
    MessagePtr message;
  };
  static constexpr Time kNever = Time::from_nanoseconds(INT64_MAX);

  RunResult run_alone() {
    deliver(constructed_);
    while (!stop_.requested()) {
      run_instant();
      if (stop_.requested()) break;
      const Time next = next_timer();
      if (next == kNever) {
        stop_.set("no message or timer is left", false);
        break;
      }
      advance_to(next);
    }
    return stop_.result(now_);
  }

  /// With other processes: each step is exchanged before the next one runs. All processes conclude
  /// the same from it.
  RunResult run_shared() {
    StepExchange& exchange = *shared_->exchange;
    std::vector<Time> next_timers(exchange.size(), kNever);
    std::vector<bool> active(exchange.size(), true);
    std::shared_ptr<Step> mine = make_step(constructed_);
    for (std::uint64_t number = 0;; ++number) {
      const auto steps = exchange.exchange(number, active, std::move(mine));
      if (!steps.ok()) {
        stop_.set(steps.error().message, true);
        return stop_.result(now_);
      }
      if (!deliver_all(*steps)) {
        stop_.set("a message from another process is malformed", true);
        return stop_.result(now_);
      }
      for (std::size_t i = 0; i < steps->size(); ++i) {
        const Step* step = (*steps)[i].get();
        if (step == nullptr) continue;
        if (step->stop()) return {step->reason(), step->failed(), now_};
        next_timers[i] = Time::from_nanoseconds(step->next_timer_ns());
      }
      active = woken_by(*steps);
      if (std::ranges::find(active, true) == active.end()) {
        const Time next = std::ranges::min(next_timers);
        if (next == kNever) return {"no message or timer is left", false, now_};
        advance_to(next);
        for (std::size_t i = 0; i < active.size(); ++i) active[i] = next_timers[i] <= now_;
      }
      const bool mine_runs = active[exchange.own()];
      if ((number + 1) % StepExchange::kAllTakePart == 0) active.assign(active.size(), true);
      if (mine_runs) run_step();
      if (active[exchange.own()]) mine = make_step(collect());
    }
  }

  /// The processes that have messages within the instant.
  [[nodiscard]] std::vector<bool> woken_by(const StepExchange::Steps& steps) const {
    std::vector<bool> woken(steps.size(), false);
    for (const auto& step : steps) {
      if (step == nullptr) continue;
      for (const std::uint32_t topic : step->topics()) {
        if (topic >= shared_->topics.size()) continue;
        const std::vector<bool>& read_by = shared_->topics[topic].read_by;
        for (std::size_t i = 0; i < woken.size(); ++i) woken[i] = woken[i] || read_by[i];
      }
    }
    return woken;
  }

  [[nodiscard]] std::vector<Published> collect() {
    std::vector<Published> published;
    for (std::vector<Published>& outbox : outboxes_) {
      std::ranges::move(outbox, std::back_inserter(published));
      outbox.clear();
    }
    return published;
  }

  /// This process's part of a step. Its messages are kept in own_ for deliver_all().
  [[nodiscard]] std::shared_ptr<Step> make_step(std::vector<Published> published) {
    auto step = std::make_shared<Step>();
    step->next_timer_ns(next_timer().count_ns());
    // abort() tells the others of an interruption. Here it would reach only some of them in time.
    if (stop_.requested() && !interrupted_) {
      const RunResult result = stop_.result(now_);
      step->stop(true);
      step->reason(result.reason);
      step->failed(result.failed);
    }
    own_.clear();
    for (Published& entry : published) {
      const std::uint32_t index = entry.route->topic_index;
      const SharedLockstep::Topic& topic = shared_->topics[index];
      const std::uint32_t component = shared_->component_of_node[index_of(*entry.from)];
      entry.route->write_to_transport(entry.message);
      if (std::ranges::find(topic.read_by, true) != topic.read_by.end()) {
        step->topics().push_back(index);
      }
      if (topic.read_elsewhere) {
        StepMessage& out = step->messages().emplace_back();
        out.topic(index);
        out.publisher(component);
        out.cdr().resize(topic.type->serialized_size(entry.message.get()));
        const auto bytes = std::as_writable_bytes(std::span(out.cdr()));
        if (!topic.type->serialize(entry.message.get(), bytes).ok()) out.cdr().clear();
      }
      own_.push_back({component, index, std::move(entry.message)});
    }
    std::ranges::sort(step->topics());
    step->topics().erase(std::unique(step->topics().begin(), step->topics().end()),
                         step->topics().end());
    return step;
  }

  /// Delivers the messages of a step to the inputs of this process, in the order of the graph's
  /// components. False if a message cannot be deserialized.
  [[nodiscard]] bool deliver_all(const StepExchange::Steps& steps) {
    std::vector<Delivery> deliveries = std::exchange(own_, {});
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (i == shared_->exchange->own() || steps[i] == nullptr) continue;
      for (const StepMessage& message : steps[i]->messages()) {
        if (message.topic() >= shared_->topics.size()) return false;
        const SharedLockstep::Topic& topic = shared_->topics[message.topic()];
        if (topic.readers.empty()) continue;
        std::shared_ptr<void> copy = topic.type->create();
        if (!topic.type->deserialize(std::as_bytes(std::span(message.cdr())), copy.get()).ok())
          return false;
        deliveries.push_back({message.publisher(), message.topic(), std::move(copy)});
      }
    }
    std::ranges::stable_sort(deliveries, {}, &Delivery::component);
    for (const Delivery& delivery : deliveries) {
      for (const Route::Reader& reader : shared_->topics[delivery.topic].readers) {
        reader.node->push(reader.input, delivery.message);
      }
    }
    return true;
  }

  [[nodiscard]] std::size_t index_of(const Node& node) const {
    const auto it = std::ranges::find(nodes_, &node, &std::unique_ptr<Node>::get);
    return static_cast<std::size_t>(it - nodes_.begin());
  }

  void run_instant() {
    while (!stop_.requested() && run_step()) {
      for (const std::size_t i : ready_) deliver(outboxes_[i]);
    }
  }

  /// False if no node has messages or a due timer.
  bool run_step() {
    take_from_transport();
    ready_.clear();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i]->has_messages() || timer_due(*nodes_[i])) ready_.push_back(i);
    }
    workers_.parallel_for(ready_.size(), [this](std::size_t k) { run_node(*nodes_[ready_[k]]); });
    return !ready_.empty();
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
      published.route->write_to_transport(published.message);
    }
    outbox.clear();
  }

  void take_from_transport() {
    const MutexLock lock(transport_mutex_);
    for (auto& [reader, message] : from_transport_)
      reader.node->push(reader.input, std::move(message));
    from_transport_.clear();
  }

  // Between steps no node runs, so the status is the same on any number of threads.
  void advance_to(Time next) {
    constexpr std::int64_t kSecond_ns = 1'000'000'000;
    const bool crossed = next.count_ns() / kSecond_ns > now_.count_ns() / kSecond_ns;
    now_ = next;
    if (crossed && each_second_) each_second_(now_);
  }

  [[nodiscard]] Time next_timer() const {
    Time next = kNever;
    for (const auto& node : nodes_) {
      for (const Node::Timer& timer : node->timers()) next = std::min(next, timer.next);
    }
    return next;
  }

  WorkerPool workers_;
  StopRequest stop_;
  std::atomic<bool> interrupted_ = false;
  Time now_;
  bool running_ = false;
  std::span<const std::unique_ptr<Node>> nodes_;
  std::vector<std::vector<Published>> outboxes_;
  std::vector<Published> constructed_;
  std::vector<std::size_t> ready_;
  Mutex transport_mutex_;
  std::vector<std::pair<Route::Reader, MessagePtr>> from_transport_
      FURROW_GUARDED_BY(transport_mutex_);
  std::unique_ptr<SharedLockstep> shared_;
  std::vector<Delivery> own_;
};

}  // namespace

std::unique_ptr<Executor> make_lockstep_executor(int threads) {
  return std::make_unique<LockstepExecutor>(threads);
}

}  // namespace furrow::graph
