#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <utility>

#include "furrow_graph/runtime.hpp"
#include "node.hpp"
#include "shared_lockstep.hpp"

namespace furrow::graph {

/// Calls the nodes of a process until it is stopped.
class Executor : public NodeHost {
 public:
  /// Messages that constructors published before run() are delivered at its start.
  virtual RunResult run(std::span<const std::unique_ptr<Node>> nodes) = 0;
  /// Puts a message from outside the process into the reader's mailbox. From any thread.
  virtual void deliver_from_transport(const Route::Reader& reader, MessagePtr message) = 0;
  /// Before run(): `callback` is called at every second of the clock, in lock-step between two
  /// simulation steps.
  void every_second(std::function<void(Time)> callback) { each_second_ = std::move(callback); }
  /// Ends the run as soon as possible. From any thread.
  virtual void interrupt(std::string_view reason) { request_stop(reason, false); }
  /// Before run(): makes this lock-step one of several processes.
  virtual void share(std::unique_ptr<SharedLockstep> /*shared*/) {}

 protected:
  std::function<void(Time)> each_second_;
};

[[nodiscard]] std::unique_ptr<Executor> make_lockstep_executor(int threads);
[[nodiscard]] std::unique_ptr<Executor> make_realtime_executor(int threads);

}  // namespace furrow::graph
