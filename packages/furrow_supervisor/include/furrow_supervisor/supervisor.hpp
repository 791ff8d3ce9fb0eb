#pragma once

#include <functional>
#include <string>
#include <vector>

#include "furrow_launch/signals.hpp"
#include "furrow_supervisor/child_process.hpp"
#include "furrow_supervisor/restart_policy.hpp"

namespace furrow::supervisor {

struct SupervisedProcess {
  std::string name;
  std::vector<std::string> command;  ///< path of the program, and its arguments
  bool restart = true;               ///< false: its death ends the run
  bool reports = false;              ///< writes the report of the run; its result is the run's
};

struct SupervisorOptions {
  /// Called a few times a second on the thread of run(); lines that it returns are shown.
  std::function<std::vector<std::string>()> on_tick;
  /// Takes a line of a process, or of the supervisor itself (name ""). On the thread of run().
  std::function<void(const std::string& name, const std::string& text)> show;
  /// Takes a line of the supervisor itself, which is shown too: about the process `name`, or about
  /// the deployment (name ""). May be empty.
  std::function<void(const std::string& name, const std::string& text)> on_event = {};
  /// On a signal, the other processes keep running until the one that reports has ended: in
  /// lock-step it cannot make another step without them.
  bool stop_reporter_first = false;
};

/// Starts the processes of one host, restarts a process that dies, and ends all together. They end
/// when the run is finished, when a process cannot be restarted, or on SIGINT and SIGTERM. An exit
/// code says how a process ended: 0 well, 2 wrongly configured, anything else is a death.
class Supervisor {
 public:
  Supervisor(std::vector<SupervisedProcess> processes, SupervisorOptions options);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// The exit code for the user. Where a process reports, it is that of this process, also when it
  /// had to be stopped after the others saw the end of the run. Elsewhere it is 0 when the run was
  /// finished. To be called once.
  [[nodiscard]] int run();

 private:
  struct Entry;

  void tell(const std::string& name, const std::string& text);
  void start(Entry& entry);
  void take_signals();
  void read_output(Entry& entry);
  void reap(Entry& entry);
  void ended_well(Entry& entry);
  void died(Entry& entry, int wait_status);
  void start_due();
  /// Asks all processes to end.
  void stop();
  /// Asks the process that reports to end, and the others when it has.
  void stop_reporter();
  /// A second signal: nothing gets more than the shortest time to end.
  void hurry();
  void ask_to_end(Entry& entry, Time now);
  void stop_when_due();
  [[nodiscard]] bool any_alive() const;
  [[nodiscard]] bool reporter_alive() const;

  std::vector<Entry> entries_;
  SupervisorOptions options_;
  launch::SignalPipe signals_;
  bool stopping_ = false;
  bool waits_for_reporter_ = false;
  bool finished_ = false;  // some process saw the end of the run
  int result_ = 0;
  Time stop_at_;  // when finished: those that have not seen it are told to stop
};

}  // namespace furrow::supervisor
