#pragma once

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>

namespace furrow {

/// For tests only: how much other programs, and the host of a virtual machine, computed since the
/// construction. Child processes count as own ones once they were waited for.
class OtherWork {
 public:
  OtherWork() : start_(now()) {}

  /// In processors: 1 is one processor kept busy all the time.
  [[nodiscard]] double processors() const {
    const Reading end = now();
    const double elapsed_s = std::chrono::duration<double>(end.time - start_.time).count();
    return ((end.all_s - start_.all_s) - (end.own_s - start_.own_s)) / elapsed_s;
  }

 private:
  struct Reading {
    std::chrono::steady_clock::time_point time;
    double all_s;  // all processors, all programs; with what a host took away
    double own_s;  // this program and its children
  };

  static double seconds(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }

  static Reading now() {
    std::ifstream file("/proc/stat");
    std::string label;
    double user = 0, nice = 0, system = 0, idle = 0, waiting = 0, irq = 0, softirq = 0, steal = 0;
    file >> label >> user >> nice >> system >> idle >> waiting >> irq >> softirq >> steal;
    EXPECT_TRUE(file) << "/proc/stat could not be read";
    double own_s = 0.0;
    for (const auto processes : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
      rusage usage{};
      EXPECT_EQ(getrusage(processes, &usage), 0);
      own_s += seconds(usage.ru_utime) + seconds(usage.ru_stime);
    }
    const double ticks = user + nice + system + irq + softirq + steal;
    return {std::chrono::steady_clock::now(), ticks / static_cast<double>(sysconf(_SC_CLK_TCK)),
            own_s};
  }

  Reading start_;
};

/// For tests only. Passes when one of three rounds stays within `limit_ms`; `measure` makes a round
/// and returns its longest time. A round counts against the program only where others used next to
/// nothing of the machine meanwhile. Skips where no round did.
inline void expect_within_in_an_undisturbed_round(double limit_ms, const std::string& name,
                                                  const std::function<double()>& measure) {
  constexpr int kRounds = 3;
  constexpr double kUndisturbed_processors = 0.1;
  bool undisturbed = false;
  for (int round = 0; round < kRounds; ++round) {
    const OtherWork others;
    const double longest_ms = measure();
    if (testing::Test::HasFailure() || longest_ms <= limit_ms) return;
    const double processors = others.processors();
    std::printf("%s: %.2f ms; others used %.2f processors meanwhile\n", name.c_str(), longest_ms,
                processors);
    undisturbed = undisturbed || processors < kUndisturbed_processors;
  }
  if (undisturbed) {
    FAIL() << name << ": no round stayed within " << limit_ms << " ms on an undisturbed machine";
  }
  GTEST_SKIP() << name << ": the machine was busy with other work in all " << kRounds << " rounds";
}

}  // namespace furrow
