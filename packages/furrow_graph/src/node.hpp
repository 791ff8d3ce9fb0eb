#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "furrow_core/mutex.hpp"
#include "furrow_graph/context.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/runtime.hpp"
#include "furrow_log/log.hpp"
#include "lateness.hpp"
#include "mailbox.hpp"
#include "route.hpp"

namespace furrow::graph {

/// The executor as its nodes see it.
class NodeHost {
 public:
  virtual ~NodeHost() = default;
  [[nodiscard]] virtual Time now() const = 0;
  /// On the thread of the node's callback.
  virtual void publish(Node& from, Route& route, MessagePtr message) = 0;
  virtual void request_stop(std::string_view reason, bool failed) = 0;
};

/// A component of this process with its mailboxes and timers; the component's Context. Call push()
/// from any thread, and run_*() from one thread at a time.
class Node final : public Context {
 public:
  struct Timer {
    Duration period;
    Time next;
    std::function<void(Time)> callback;
  };

  Node(ComponentSpec spec, const ComponentClass& type, std::vector<GivenParameter> parameters,
       std::uint64_t seed, NodeHost& host);
  ~Node() override;

  /// Before construct(): where log() writes. Null: nowhere.
  void set_log(log::Log* log) { log_ = log; }
  /// Creates the component. The routes must outlive the node.
  void construct(std::function<Route&(const std::string& topic)> route_of);
  void destroy_component() { component_.reset(); }

  [[nodiscard]] const ComponentSpec& spec() const { return spec_; }
  /// The index of the input that reads `topic`, if the component has one.
  [[nodiscard]] std::optional<std::size_t> input_of(const std::string& topic) const;

  void push(std::size_t input, MessagePtr message);
  [[nodiscard]] bool has_messages() const;
  /// Handles the messages that are waiting now, oldest first.
  void run_messages();

  [[nodiscard]] std::vector<Timer>& timers() { return timers_; }
  void run_timer(std::size_t timer, Time due);
  void count_missed_timer() { ++missed_timers_; }
  /// For the status: the thread that calls the node, and whether memory is locked.
  void set_thread(std::string text);
  void set_memory(std::string text);

  [[nodiscard]] ComponentStatus status() const;

  // Context
  [[nodiscard]] const std::string& name() const override { return spec_.name; }
  [[nodiscard]] Time now() const override { return host_.now(); }
  [[nodiscard]] Time arrival() const override { return arrival_; }
  [[nodiscard]] std::uint64_t seed() const override { return seed_; }
  void every(Duration period, std::function<void(Time)> callback) override;
  void health(HealthLevel level, std::string_view message) override;
  void count(std::string_view counter, std::int64_t by) override;
  void log(log::Level level, std::string_view message) override;
  void request_stop(std::string_view reason) override { host_.request_stop(reason, false); }

 protected:
  [[nodiscard]] const std::vector<GivenParameter>& given_parameters() const override {
    return parameters_;
  }
  void bind_input(const msgs::Topic& topic, std::function<void(const MessagePtr&)> callback,
                  int depth) override;
  [[nodiscard]] std::function<void(MessagePtr)> bind_output(const msgs::Topic& topic) override;

 private:
  struct Input {
    std::string topic;
    std::size_t depth;
    std::function<void(const MessagePtr&)> callback;
    std::size_t waiting = 0;
    std::uint64_t received = 0;
    std::uint64_t dropped = 0;
    std::uint64_t dropped_logged = 0;
  };

  /// Calls the component and measures the time. An exception stops the run.
  template <class Callback>
  void call(const Callback& callback);
  /// Logs the messages that the mailbox of an input dropped since the last call.
  void log_drops(const std::string& topic, std::uint64_t count);
  void require_declared(const std::vector<PortInfo>& ports, const msgs::Topic& topic) const;

  ComponentSpec spec_;
  const ComponentClass& type_;
  std::vector<GivenParameter> parameters_;
  std::uint64_t seed_;
  NodeHost& host_;
  log::Log* log_ = nullptr;
  std::function<Route&(const std::string&)> route_of_;
  std::unique_ptr<Component> component_;
  std::vector<Timer> timers_;
  Time arrival_;  // of the current message

  mutable Mutex mutex_;
  std::vector<Input> inputs_ FURROW_GUARDED_BY(mutex_);
  Mailbox mail_ FURROW_GUARDED_BY(mutex_);
  Health health_ FURROW_GUARDED_BY(mutex_);
  std::uint64_t callbacks_ FURROW_GUARDED_BY(mutex_) = 0;
  double busy_s_ FURROW_GUARDED_BY(mutex_) = 0.0;
  double longest_call_s_ FURROW_GUARDED_BY(mutex_) = 0.0;
  LatenessHistogram lateness_ FURROW_GUARDED_BY(mutex_);
  std::string thread_ FURROW_GUARDED_BY(mutex_) = "pool";
  std::string memory_ FURROW_GUARDED_BY(mutex_);
  std::atomic<std::uint64_t> missed_timers_ = 0;
};

}  // namespace furrow::graph
