#include "furrow_tracking/assignment.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "furrow_core/random.hpp"

namespace furrow::tracking {
namespace {

double total_cost(std::span<const std::int32_t> columns, std::span<const CandidatePair> pairs,
                  double unmatched_cost) {
  double total = 0.0;
  for (std::size_t row = 0; row < columns.size(); ++row) {
    if (columns[row] == SparseAssignment::kUnmatched) {
      total += unmatched_cost;
      continue;
    }
    double cost = std::numeric_limits<double>::infinity();
    for (const CandidatePair& pair : pairs) {
      if (pair.row == static_cast<std::int32_t>(row) && pair.column == columns[row]) {
        cost = std::min(cost, pair.cost);
      }
    }
    total += cost;
  }
  return total;
}

/// Tries every assignment.
double best_cost(std::int32_t row, std::int32_t rows, unsigned used,
                 std::span<const CandidatePair> pairs, double unmatched_cost) {
  if (row == rows) return 0.0;
  double best = unmatched_cost + best_cost(row + 1, rows, used, pairs, unmatched_cost);
  for (const CandidatePair& pair : pairs) {
    if (pair.row != row || (used >> pair.column & 1U) != 0U) continue;
    best = std::min(best, pair.cost + best_cost(row + 1, rows, used | 1U << pair.column, pairs,
                                                unmatched_cost));
  }
  return best;
}

TEST(SparseAssignment, AgreesWithTryingEveryAssignment) {
  SparseAssignment assignment;
  for (std::uint64_t instance = 0; instance < 3000; ++instance) {
    Random random(1, "assignment", instance);
    const auto rows = static_cast<std::int32_t>(random.integer(0, 6));
    const auto columns = static_cast<std::int32_t>(random.integer(0, 6));
    const double density = random.uniform(0.1, 1.0);
    const double unmatched_cost = random.uniform(-0.2, 1.2);
    const bool ties = random.bernoulli(0.3);
    std::vector<CandidatePair> pairs;
    for (std::int32_t row = 0; row < rows; ++row) {
      for (std::int32_t column = 0; column < columns; ++column) {
        if (!random.bernoulli(density)) continue;
        const double cost =
            ties ? 0.25 * static_cast<double>(random.integer(-1, 4)) : random.uniform(-0.3, 1.0);
        pairs.push_back({row, column, cost});
      }
    }
    const auto found = assignment.solve(rows, columns, pairs, unmatched_cost);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(rows));
    std::set<std::int32_t> taken;
    for (const std::int32_t column : found) {
      if (column != SparseAssignment::kUnmatched) {
        ASSERT_TRUE(taken.insert(column).second);
      }
    }
    ASSERT_NEAR(total_cost(found, pairs, unmatched_cost),
                best_cost(0, rows, 0, pairs, unmatched_cost), 1e-9)
        << "instance " << instance;
  }
}

TEST(SparseAssignment, GivesUpAPairForABetterWhole) {
  SparseAssignment assignment;
  // Row 0 likes column 0 best, but row 1 can only have column 0.
  const std::vector<CandidatePair> pairs = {{0, 0, 0.1}, {0, 1, 0.2}, {1, 0, 0.3}};
  const auto found = assignment.solve(2, 2, pairs, 1.0);
  EXPECT_EQ(found[0], 1);
  EXPECT_EQ(found[1], 0);
}

TEST(SparseAssignment, LeavesOutWhatIsNotAPair) {
  SparseAssignment assignment;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<CandidatePair> pairs = {{-1, 0, 0.1}, {0, -1, 0.1}, {0, 2, 0.1}, {5, 0, 0.1},
                                            {0, 0, nan},  {0, 1, 1.5},  {1, 1, 0.9}, {1, 1, 0.4}};
  const auto found = assignment.solve(2, 2, pairs, 1.0);
  EXPECT_EQ(found[0], SparseAssignment::kUnmatched);
  EXPECT_EQ(found[1], 1);
  EXPECT_TRUE(assignment.solve(0, 0, {}, 1.0).empty());
}

TEST(SparseAssignment, SolvesALongChainThatShiftsAsAWhole) {
  // Row i may have column i or i + 1; the last row has only its own column, so that each new row
  // in the order of solving pushes all others along.
  constexpr std::int32_t kRows = 2000;
  std::vector<CandidatePair> pairs;
  for (std::int32_t row = 0; row < kRows; ++row) {
    pairs.push_back({row, row, 0.9});
    if (row + 1 < kRows) pairs.push_back({row, row + 1, 0.1});
  }
  SparseAssignment assignment;
  const auto found = assignment.solve(kRows, kRows, pairs, 1.0);
  // Best: all but the last take the next column and the last stays alone. Each other solution
  // lets some row pay 0.9 where it paid 0.1, and frees nothing dearer.
  EXPECT_NEAR(total_cost(found, pairs, 1.0), (kRows - 1) * 0.1 + 1.0, 1e-9);
}

}  // namespace
}  // namespace furrow::tracking
