#include "supervisor.hpp"

#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <iostream>
#include <optional>

namespace furrow::cli {
namespace {

constexpr int kTickMs = 100;
constexpr int kBadConfiguration = 2;
// From the first process that saw the end of the run to the end of the others.
constexpr Duration kFinishGrace = Duration::milliseconds(5'000);
// A process that is told to stop needs a moment to leave the network in good order.
constexpr Duration kStopGrace = Duration::milliseconds(1'500);
constexpr std::size_t kLongestLine = 4096;

Time steady_now() {
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
  std::string line;  // of its output, as far as it came
};

Supervisor::Supervisor(std::vector<SupervisedProcess> processes,
                       std::function<std::vector<std::string>()> on_tick)
    : on_tick_(std::move(on_tick)), signals_({SIGINT, SIGTERM, SIGCHLD}) {
  for (SupervisedProcess& process : processes) {
    name_width_ = std::max(name_width_, process.name.size());
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
    (void)poll(polled.data(), polled.size(), kTickMs);
    take_signals();
    for (Entry& entry : entries_) {
      if (!entry.child) continue;
      read_output(entry);
      reap(entry);
    }
    start_due();
    stop_when_due();
    for (const std::string& line : on_tick_()) say("", line);
  }
  return result_;
}

void Supervisor::start(Entry& entry) {
  entry.start_at.reset();
  auto child = ChildProcess::start(entry.process.command);
  if (!child.ok()) {
    say(entry.process.name, child.error().message);
    result_ = 1;
    stop(kStopGrace);
    return;
  }
  entry.child.emplace(std::move(child).value());
}

void Supervisor::take_signals() {
  while (const int signal = signals_.take()) {
    if (signal == SIGCHLD) continue;
    if (!stopping_) say("", "interrupted: stopping all processes");
    result_ = 1;
    stop(kStopGrace);
  }
}

void Supervisor::read_output(Entry& entry) {
  std::array<char, 4096> buffer{};
  ssize_t got = 0;
  while ((got = read(entry.child->output(), buffer.data(), buffer.size())) > 0) {
    for (const char c : std::string_view(buffer.data(), static_cast<std::size_t>(got))) {
      if (c != '\n' && entry.line.size() < kLongestLine) {
        entry.line += c;
      } else {
        say(entry.process.name, entry.line);
        entry.line.clear();
      }
    }
  }
}

void Supervisor::reap(Entry& entry) {
  int status = 0;
  if (!entry.child->ended(status)) return;
  read_output(entry);
  if (!entry.line.empty()) say(entry.process.name, entry.line);
  entry.line.clear();
  entry.child.reset();
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
  if (entry.process.reports && code != 0 && (finished_ || !stopping_)) result_ = code;
  if (code == 0) {
    ended_well(entry);
  } else if (!stopping_ && code == kBadConfiguration) {
    result_ = kBadConfiguration;
    stop(kStopGrace);
  } else if (!stopping_) {
    died(entry, status);
  }
}

void Supervisor::ended_well(Entry& entry) {
  if (stopping_) return;
  if (entry.process.reports) result_ = 0;
  if (!finished_) stop_at_ = steady_now() + kFinishGrace;
  finished_ = true;
}

void Supervisor::died(Entry& entry, int wait_status) {
  const std::string how = how_it_ended(wait_status);
  if (finished_) {
    say(entry.process.name, how + " at the end of the run");
    if (entry.process.reports) result_ = 1;
    return;
  }
  if (!entry.process.restart) {
    say(entry.process.name, how + "; the run cannot go on without it");
    result_ = 1;
    stop(kStopGrace);
    return;
  }
  const Time now = steady_now();
  entry.start_at = entry.policy.after_death(now);
  if (!entry.start_at) {
    say(entry.process.name, how + ", too often: giving up");
    result_ = 1;
    stop(kStopGrace);
    return;
  }
  result_ = 0;  // it may yet do what it is for
  const std::int64_t delay_ms = (*entry.start_at - now).count_ns() / 1'000'000;
  say(entry.process.name, how + "; started again in " + std::to_string(delay_ms) + " ms");
}

void Supervisor::start_due() {
  for (Entry& entry : entries_) {
    if (entry.start_at && *entry.start_at <= steady_now()) start(entry);
  }
}

void Supervisor::stop(Duration grace) {
  if (stopping_) return;
  stopping_ = true;
  kill_at_ = steady_now() + grace;
  for (Entry& entry : entries_) {
    entry.start_at.reset();
    if (entry.child) entry.child->send(SIGTERM);
  }
}

void Supervisor::stop_when_due() {
  const Time now = steady_now();
  if (finished_ && !stopping_ && now >= stop_at_) stop(kStopGrace);
  if (!stopping_ || now < kill_at_) return;
  for (Entry& entry : entries_) {
    if (!entry.child) continue;
    say(entry.process.name, "does not end: killed");
    entry.child->send(SIGKILL);
  }
  kill_at_ = now + kStopGrace;
}

bool Supervisor::any_alive() const {
  return std::ranges::any_of(
      entries_, [](const Entry& entry) { return entry.child.has_value() || entry.start_at; });
}

void Supervisor::say(const std::string& name, const std::string& text) const {
  std::string line(name_width_, ' ');
  line.replace(0, name.size(), name);
  std::cerr << line + " | " + text + "\n" << std::flush;
}

}  // namespace furrow::cli
