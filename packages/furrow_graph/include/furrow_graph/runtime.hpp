#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_graph/graph_file.hpp"
#include "furrow_graph/health.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/transport.hpp"

namespace furrow::graph {

enum class ClockMode : std::uint8_t {
  kLockstep,  ///< simulated time, as fast as it goes, the same bytes on any number of threads
  kReal,      ///< the computer's clock
};

struct RuntimeOptions {
  ClockMode clock = ClockMode::kReal;
  int threads = 2;
  std::uint64_t seed = 1;
  std::vector<std::string> components;            ///< of this process; empty: all
  Transport* transport = nullptr;                 ///< none: nothing leaves the process
  std::string process;                            ///< this one's name
  std::vector<PlacedProcess> processes = {};      ///< of the whole deployment; empty: only this one
  std::function<Health()> transport_health = {};  ///< for the diagnostics; called once a second
};

struct InputStatus {
  std::string topic;
  std::uint64_t received = 0;
  std::uint64_t dropped = 0;
};

/// What one component did so far.
struct ComponentStatus {
  std::string name;
  std::string class_name;
  Health health;
  std::vector<InputStatus> inputs;
  std::uint64_t callbacks = 0;
  std::uint64_t missed_timers = 0;
  double busy_s = 0.0;  ///< wall-clock time inside callbacks
  double longest_call_s = 0.0;
  std::uint64_t timers = 0;  ///< timer callbacks that were called
  Duration timer_late_p50;   ///< how late they were called; 0 in lock-step
  Duration timer_late_p99;
  Duration timer_late_max;
  std::string thread;  ///< "pool", or "dedicated" with what was granted or refused
};

struct RunResult {
  std::string reason;   ///< of the stop
  bool failed = false;  ///< a callback threw; `reason` says which and what
  Time end;             ///< of the graph's clock
};

/// The components of one process and the executor that calls them. Construction checks the whole
/// graph and throws ConfigError; destruction stops the executor before any component goes. Every
/// second of the graph's clock it publishes the health of its components on `diagnostics`.
class Runtime {
 public:
  Runtime(const GraphSpec& graph, Registry& registry, const RuntimeOptions& options);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  /// Runs until a component or request_stop() ends it; in lock-step also when nothing is left to
  /// do. To be called once.
  RunResult run();
  /// From any thread.
  void request_stop(std::string_view reason);
  /// Of the components of the graph that live here. From any thread.
  [[nodiscard]] std::vector<ComponentStatus> status() const;
  /// Whether every other process that this one reads from or writes to is there. From any thread.
  [[nodiscard]] bool connected() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::graph
