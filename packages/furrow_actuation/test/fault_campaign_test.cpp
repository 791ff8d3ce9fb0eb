// Faults drawn by seed over short runs in closed loop and simulated time, judged by the ground
// truth. FURROW_FAULT_RUNS and FURROW_FAULT_FIRST_SEED change how many runs are made.

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "campaign/run.hpp"

namespace furrow::actuation::campaign {
namespace {

std::uint64_t from_environment(const char* name, std::uint64_t otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

TEST(FaultCampaign, NoFaultViolatesAnInvariant) {
  const std::uint64_t runs = from_environment("FURROW_FAULT_RUNS", 300);
  const std::uint64_t first = from_environment("FURROW_FAULT_FIRST_SEED", 0);
  Tally tally;
  int violated = 0;
  for (std::uint64_t seed = first; seed < first + runs; ++seed) {
    const std::string found = run(seed, tally);
    if (found.empty()) continue;
    ADD_FAILURE() << "seed " << seed << ": " << found;
    if (++violated == 10) break;
  }
  std::printf("%llu runs from seed %llu: %d violated\n", static_cast<unsigned long long>(runs),
              static_cast<unsigned long long>(first), violated);
  std::printf("%d sprays, %d stops skipped, %d causes latched, %d reset, %d resets refused\n",
              tally.sprays, tally.skipped, tally.latched, tally.resets, tally.refused);
  std::printf("%d cycles with drops behind a dead process or a lost bus, the longest %.3f s\n",
              tally.overrun_cycles, tally.longest_overrun_s);
  // A campaign in which little happens finds little.
  const auto n = static_cast<double>(runs);
  EXPECT_GT(tally.sprays, 3.0 * n);
  EXPECT_GT(tally.latched, 0.5 * n);
  EXPECT_GT(tally.resets, 0.2 * n);
}

TEST(FaultCampaign, OneSeedIsOneRun) {
  Tally first;
  Tally second;
  EXPECT_EQ(run(7, first), run(7, second));
  EXPECT_EQ(first.sprays, second.sprays);
  EXPECT_EQ(first.latched, second.latched);
  EXPECT_EQ(first.skipped, second.skipped);
}

}  // namespace
}  // namespace furrow::actuation::campaign
