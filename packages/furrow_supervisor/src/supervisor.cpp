#include "furrow_supervisor/supervisor.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <optional>
#include <string_view>
#include <utility>

#include "furrow_supervisor/line_reader.hpp"

namespace furrow::supervisor {
namespace {

constexpr int kTick_ms = 100;
constexpr int kBadConfiguration = 2;
// From the first process that saw the end of the run to the end of the others.
constexpr Duration kFinishGrace = Duration::milliseconds(5'000);
// A process that is told to stop needs a moment to leave the network in good order.
constexpr Duration kStopGrace = Duration::milliseconds(1'500);
// Of the process that reports: it accounts for every plant and draws the map.
constexpr Duration kReportGrace = Duration::milliseconds(15'000);

Time now_by_steady_clock() {
  return Time::from_nanoseconds(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                    std::chrono::steady_clock::now().time_since_epoch())
                                    .count());
}

std::string how_it_ended(int wait_status) {
  if (WIFSIGNALED(wait_status)) {
    return "was ended by signal " + std::to_string(WTERMSIG(wait_status));
  }
  return "ended with exit code " + std::to_string(WEXITSTATUS(wait_status));
}

}  // namespace

struct Supervisor::Entry {
  SupervisedProcess process;
  std::optional<ChildProcess> child;
  RestartPolicy policy;
  std::optional<Time> start_at;
  std::optional<Time> kill_at;  // when it was asked to end
  LineReader lines;             // of its output
};

Supervisor::Supervisor(std::vector<SupervisedProcess> processes, SupervisorOptions options)
    : options_(std::move(options)), signals_({SIGINT, SIGTERM, SIGCHLD}) {
  for (SupervisedProcess& process : processes) {
    entries_.push_back({.process = std::move(process)});
  }
}

Supervisor::~Supervisor() {
  entries_.clear();
}

int Supervisor::run() {
  for (Entry& entry : entries_) start(entry);
  while (any_alive()) {
    std::vector<pollfd> polled = {{signals_.fd(), POLLIN, 0}};
    for (const Entry& entry : entries_) {
      if (entry.child) polled.push_back({entry.child->output(), POLLIN, 0});
    }
    (void)poll(polled.data(), polled.size(), kTick_ms);
    take_signals();
    for (Entry& entry : entries_) {
      if (!entry.child) continue;
      read_output(entry);
      reap(entry);
    }
    start_due();
    stop_when_due();
    for (const std::string& line : options_.on_tick()) tell("", line);
  }
  return result_;
}

void Supervisor::tell(const std::string& name, const std::string& text) {
  options_.show(name, text);
  if (options_.on_event) options_.on_event(name, text);
}

void Supervisor::start(Entry& entry) {
  entry.start_at.reset();
  auto child = ChildProcess::start(entry.process.command);
  if (!child.ok()) {
    tell(entry.process.name, child.error().message);
    result_ = 1;
    stop();
    return;
  }
  entry.child.emplace(std::move(child).value());
}

void Supervisor::take_signals() {
  while (const int signal = signals_.take()) {
    if (signal == SIGCHLD) continue;
    result_ = 1;
    if (stopping_) {
      hurry();
      continue;
    }
    tell("", "interrupted: stopping all processes");
    if (options_.stop_reporter_first && reporter_alive()) {
      stop_reporter();
    } else {
      stop();
    }
  }
}

void Supervisor::read_output(Entry& entry) {
  std::array<char, 4096> buffer{};
  ssize_t got = 0;
  while ((got = read(entry.child->output(), buffer.data(), buffer.size())) > 0) {
    const std::string_view piece(buffer.data(), static_cast<std::size_t>(got));
    for (const std::string& line : entry.lines.add(piece)) {
      options_.show(entry.process.name, line);
    }
  }
}

void Supervisor::reap(Entry& entry) {
  int status = 0;
  if (!entry.child->ended(status)) return;
  read_output(entry);
  if (const auto rest = entry.lines.take_rest()) options_.show(entry.process.name, *rest);
  entry.child.reset();
  entry.kill_at.reset();
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  if (entry.process.reports && code != 0 && (finished_ || !stopping_)) result_ = code;
  if (code == 0) {
    ended_well(entry);
  } else if (!stopping_ && code == kBadConfiguration) {
    result_ = kBadConfiguration;
    stop();
  } else if (!stopping_) {
    died(entry, status);
  }
  if (waits_for_reporter_ && !reporter_alive()) stop();
}

void Supervisor::ended_well(Entry& entry) {
  if (stopping_) return;
  if (entry.process.reports) result_ = 0;
  if (!finished_) stop_at_ = now_by_steady_clock() + kFinishGrace;
  finished_ = true;
}

void Supervisor::died(Entry& entry, int wait_status) {
  const std::string how = how_it_ended(wait_status);
  if (finished_) {
    tell(entry.process.name, how + " at the end of the run");
    if (entry.process.reports) result_ = 1;
    return;
  }
  if (!entry.process.restart) {
    tell(entry.process.name, how + "; the run cannot go on without it");
    result_ = 1;
    stop();
    return;
  }
  const Time now = now_by_steady_clock();
  entry.start_at = entry.policy.after_death(now);
  if (!entry.start_at) {
    tell(entry.process.name, how + ", too often: giving up");
    result_ = 1;
    stop();
    return;
  }
  result_ = 0;  // it may yet do what it is for
  const std::int64_t delay_ms = (*entry.start_at - now).count_ns() / 1'000'000;
  tell(entry.process.name, how + "; started again in " + std::to_string(delay_ms) + " ms");
}

void Supervisor::start_due() {
  for (Entry& entry : entries_) {
    if (entry.start_at && *entry.start_at <= now_by_steady_clock()) start(entry);
  }
}

void Supervisor::stop() {
  waits_for_reporter_ = false;
  stopping_ = true;
  const Time now = now_by_steady_clock();
  for (Entry& entry : entries_) ask_to_end(entry, now);
}

void Supervisor::stop_reporter() {
  stopping_ = true;
  waits_for_reporter_ = true;
  for (Entry& entry : entries_) {
    entry.start_at.reset();
    if (entry.process.reports) ask_to_end(entry, now_by_steady_clock());
  }
}

void Supervisor::hurry() {
  stop();
  const Time latest = now_by_steady_clock() + kStopGrace;
  for (Entry& entry : entries_) {
    if (entry.kill_at) entry.kill_at = std::min(*entry.kill_at, latest);
  }
}

void Supervisor::ask_to_end(Entry& entry, Time now) {
  entry.start_at.reset();
  if (!entry.child || entry.kill_at) return;
  entry.kill_at = now + (entry.process.reports ? kReportGrace : kStopGrace);
  entry.child->send(SIGTERM);
}

void Supervisor::stop_when_due() {
  const Time now = now_by_steady_clock();
  if (finished_ && !stopping_ && now >= stop_at_) stop();
  for (Entry& entry : entries_) {
    if (!entry.child || !entry.kill_at || now < *entry.kill_at) continue;
    tell(entry.process.name, "does not end: killed");
    entry.child->send(SIGKILL);
    entry.kill_at = now + kStopGrace;
  }
}

bool Supervisor::any_alive() const {
  return std::ranges::any_of(
      entries_, [](const Entry& entry) { return entry.child.has_value() || entry.start_at; });
}

bool Supervisor::reporter_alive() const {
  return std::ranges::any_of(entries_, [](const Entry& entry) {
    return entry.process.reports && entry.child.has_value();
  });
}

}  // namespace furrow::supervisor
