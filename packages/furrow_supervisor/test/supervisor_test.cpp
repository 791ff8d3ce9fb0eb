#include "furrow_supervisor/supervisor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <functional>
#include <utility>

namespace furrow::supervisor {
namespace {

using Shown = std::vector<std::string>;

SupervisedProcess shell(const std::string& name, const std::string& script) {
  return {.name = name, .command = {"/bin/sh", "-c", script}, .restart = false};
}

/// Runs to the end; what was shown, as "name: text", is added to `shown`.
int run(
    std::vector<SupervisedProcess> processes, Shown& shown, std::function<void()> on_tick = [] {},
    bool stop_reporter_first = false) {
  Supervisor supervisor(
      std::move(processes),
      {.on_tick =
           [&on_tick] {
             on_tick();
             return std::vector<std::string>();
           },
       .show = [&shown](const std::string& name,
                        const std::string& text) { shown.push_back(name + ": " + text); },
       .stop_reporter_first = stop_reporter_first});
  return supervisor.run();
}

std::ptrdiff_t place(const Shown& shown, const std::string& line) {
  return std::ranges::find(shown, line) - shown.begin();
}

TEST(Supervisor, ShowsEveryByteOfALongLine) {
  // 10'000 letters without a newline until the end.
  Shown shown;
  EXPECT_EQ(run({shell("a", "head -c 10000 /dev/zero | tr '\\0' x >&2; echo >&2")}, shown), 0);
  std::size_t letters = 0;
  for (const std::string& line : shown) letters += line.size() - std::string("a: ").size();
  EXPECT_EQ(letters, 10'000u);
}

TEST(Supervisor, ResultIsThatOfTheProcessThatReports) {
  SupervisedProcess reporter = shell("reporter", "exit 1");
  reporter.reports = true;
  Shown shown;
  EXPECT_EQ(run({reporter, shell("other", "exit 0")}, shown), 1);
}

TEST(Supervisor, BadConfigurationOfOneEndsAll) {
  Shown shown;
  EXPECT_EQ(run({shell("a", "exit 2"), shell("b", "sleep 60")}, shown), 2);
}

TEST(Supervisor, DeathOfAProcessThatIsNotRestartedEndsAll) {
  Shown shown;
  EXPECT_EQ(run({shell("a", "kill -9 $$"), shell("b", "sleep 60")}, shown), 1);
  EXPECT_LT(place(shown, "a: was ended by signal 9; the run cannot go on without it"),
            std::ssize(shown));
}

TEST(Supervisor, RestartsWhatDies) {
  SupervisedProcess process = shell("a", "echo started >&2; exit 3");
  process.restart = true;
  Shown shown;
  EXPECT_EQ(run({process}, shown), 1);
  EXPECT_EQ(std::ranges::count(shown, "a: started"), RestartPolicy::kLimit + 1);
}

TEST(Supervisor, SignalEndsAll) {
  Shown shown;
  bool raised = false;
  EXPECT_EQ(run({shell("a", "sleep 60"), shell("b", "sleep 60")}, shown,
                [&] {
                  if (!std::exchange(raised, true)) raise(SIGINT);
                }),
            1);
  EXPECT_EQ(shown.front(), ": interrupted: stopping all processes");
}

TEST(Supervisor, InLockstepASignalReachesTheReporterFirst) {
  const std::string until_told =
      "trap 'echo told >&2; exit 0' TERM; echo up >&2; "
      "while :; do sleep 0.01; done";
  SupervisedProcess reporter =
      shell("reporter",
            "trap 'echo told >&2; sleep 0.3; echo reported >&2; exit 0' TERM; "
            "echo up >&2; while :; do sleep 0.01; done");
  reporter.reports = true;
  Shown shown;
  bool raised = false;
  const int result = run(
      {shell("other", until_told), reporter}, shown,
      [&] {
        const bool all_up = std::ranges::count(shown, "other: up") == 1 &&
                            std::ranges::count(shown, "reporter: up") == 1;
        if (all_up && !std::exchange(raised, true)) raise(SIGINT);
      },
      true);
  EXPECT_EQ(result, 1);
  EXPECT_LT(place(shown, "reporter: reported"), place(shown, "other: told"));
  EXPECT_LT(place(shown, "other: told"), std::ssize(shown));
}

}  // namespace
}  // namespace furrow::supervisor
