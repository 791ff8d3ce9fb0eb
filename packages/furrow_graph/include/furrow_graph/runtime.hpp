#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "furrow_core/time.hpp"
#include "furrow_graph/graph_spec.hpp"
#include "furrow_graph/health.hpp"
#include "furrow_graph/registry.hpp"
#include "furrow_graph/transport.hpp"
#include "furrow_log/log.hpp"

namespace furrow::graph {

enum class ClockMode : std::uint8_t {
  kLockstep,  ///< simulated time, as fast as possible; the same bytes on any number of threads
  kReal,      ///< the computer's clock
};

struct RuntimeOptions {
  ClockMode clock = ClockMode::kReal;
  int threads = 2;
  std::uint64_t seed = 1;
  std::vector<std::string> components;            ///< of this process; empty: all
  Transport* transport = nullptr;                 ///< null: no message leaves it
  std::string process;                            ///< its name
  std::vector<PlacedProcess> processes = {};      ///< the whole deployment; empty: one
  std::function<Health()> transport_health = {};  ///< for the diagnostics; called once a second
  log::Log* log = nullptr;  ///< outlives the runtime; also published on `rosout`. Null: no log
};

struct InputStatus {
  std::string topic;
  std::uint64_t received = 0;
  std::uint64_t dropped = 0;
};

/// Counters of one component since the start.
struct ComponentStatus {
  std::string name;
  std::string class_name;
  Health health;
  std::vector<InputStatus> inputs;
  std::uint64_t callbacks = 0;
  std::uint64_t missed_timers = 0;
  double busy_s = 0.0;  ///< wall-clock time within callbacks
  double longest_call_s = 0.0;
  std::uint64_t timers = 0;  ///< calls of timer callbacks
  Duration timer_late_p50;   ///< delay of these calls; 0 in lock-step
  Duration timer_late_p99;
  Duration timer_late_max;
  std::string thread;  ///< "pool", or "dedicated" with the granted or refused priority
};

struct RunResult {
  std::string reason;   ///< of the stop
  bool failed = false;  ///< a callback threw; `reason` says which and what
  Time end;             ///< of the graph's clock
};

/// The components of one process and the executor that calls them. Construction checks the whole
/// graph and throws ConfigError. Every second of the graph's clock it publishes the health of its
/// components on `diagnostics`.
class Runtime {
 public:
  Runtime(const GraphSpec& graph, Registry& registry, const RuntimeOptions& options);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  /// Runs until a component or request_stop() ends it. In lock-step it also ends without pending
  /// messages and timers. Call it once.
  RunResult run();
  /// From any thread.
  void request_stop(std::string_view reason);
  /// Of the graph's components in this process. From any thread.
  [[nodiscard]] std::vector<ComponentStatus> status() const;
  /// True if this process is matched with every process that it reads from or writes to. From any
  /// thread.
  [[nodiscard]] bool connected() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace furrow::graph
