#pragma once

#include <functional>
#include <string>
#include <vector>

#include "child_process.hpp"
#include "restart_policy.hpp"
#include "signals.hpp"

namespace furrow::cli {

struct SupervisedProcess {
  std::string name;
  std::vector<std::string> command;
  bool restart = true;   ///< false: its death ends the run
  bool reports = false;  ///< its result is that of the run
};

/// Starts the processes of one host, starts again what dies, and ends all together: when the run
/// is finished, when a process cannot go on, or on SIGINT and SIGTERM. A process says by its exit
/// code how it ended: 0 well, 2 wrongly configured, anything else is a death.
class Supervisor {
 public:
  /// `on_tick` is called a few times a second; lines that it returns are shown.
  Supervisor(std::vector<SupervisedProcess> processes,
             std::function<std::vector<std::string>()> on_tick);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Exit code for the user: that of the process that reports, also where it had to be stopped
  /// after the others saw the end of the run; else 0 when the run was finished.
  [[nodiscard]] int run();

 private:
  struct Entry;

  void start(Entry& entry);
  void take_signals();
  void read_output(Entry& entry);
  void reap(Entry& entry);
  void ended_well(Entry& entry);
  void died(Entry& entry, int wait_status);
  void start_due();
  /// Asks all to end within `grace`; whoever is still there then is killed.
  void stop(Duration grace);
  void stop_when_due();
  [[nodiscard]] bool any_alive() const;
  void say(const std::string& name, const std::string& text) const;

  std::vector<Entry> entries_;
  std::function<std::vector<std::string>()> on_tick_;
  std::size_t name_width_ = 0;
  SignalPipe signals_;
  bool stopping_ = false;
  bool finished_ = false;  // some process saw the end of the run
  int result_ = 0;
  Time stop_at_;  // when finished: those who have not seen it are told to stop
  Time kill_at_;  // when stopping
};

}  // namespace furrow::cli
