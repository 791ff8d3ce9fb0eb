#pragma once

#include <memory>
#include <span>
#include <string>

#include "furrow_graph/runtime.hpp"
#include "node.hpp"

namespace furrow::graph {

class StepExchange;

/// What a process knows of the others with which it runs in lock-step.
struct SharedLockstep {
  struct Topic {
    const msgs::MessageType* type = nullptr;
    std::vector<Route::Reader> readers;  ///< in this process
    std::vector<bool> read_by;           ///< by process, this one included
    bool read_elsewhere = false;
  };
  SharedLockstep();
  ~SharedLockstep();
  std::unique_ptr<StepExchange> exchange;
  std::vector<Topic> topics;                     ///< as the graph's connections
  std::vector<std::uint32_t> component_of_node;  ///< index in the graph, by node of this process
};

/// Calls the nodes of a process until it is stopped.
class Executor : public NodeHost {
 public:
  /// Before run(): messages published by constructors wait for it.
  virtual RunResult run(std::span<const std::unique_ptr<Node>> nodes) = 0;
  /// A message from outside the process, on any thread.
  virtual void deliver_from_transport(const Route::Reader& reader, MessagePtr message) = 0;
  /// Before run(): called at every second of the clock, while no node's outcome depends on it.
  virtual void every_second(std::function<void(Time)> callback) = 0;
  /// From any thread: ends the run as soon as may be.
  virtual void interrupt(std::string_view reason) { request_stop(reason, false); }
  /// Before run(): makes this lock-step one of several processes.
  virtual void share(std::unique_ptr<SharedLockstep> /*shared*/) {}
};

[[nodiscard]] std::unique_ptr<Executor> make_lockstep_executor(int threads);
/// `transport` (null: none) must live as long.
[[nodiscard]] std::unique_ptr<Executor> make_realtime_executor(int threads, Transport* transport);

/// Somebody outside reads the topic, or may come later and read what is latched.
[[nodiscard]] bool wanted_outside(const Route& route);
/// Hands a message to the transport where it is wanted.
void write_to_transport(Route& route, const MessagePtr& message);

/// Reason and failure of the first stop that was asked for. Thread-safe.
class StopRequest {
 public:
  void set(std::string_view reason, bool failed);
  [[nodiscard]] bool requested() const { return requested_; }
  [[nodiscard]] RunResult result(Time end) const;

 private:
  mutable std::mutex mutex_;
  std::atomic<bool> requested_ = false;
  std::string reason_;
  bool failed_ = false;
};

}  // namespace furrow::graph
