#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace furrow::tracking {

/// A pair that may be matched. Pairs that are not listed may not.
struct CandidatePair {
  std::int32_t row = 0;
  std::int32_t column = 0;
  double cost = 0.0;
};

/// Optimal one-to-one assignment on a sparse, gated cost matrix. Minimizes the sum of the costs of
/// the matched pairs plus `unmatched_cost` for each unmatched row. So no pair is matched at more
/// than `unmatched_cost`. Shortest augmenting paths with dual prices (Jonker and
/// Volgenant 1987), on the listed pairs only: a search never leaves the connected component of its
/// row. Buffers are kept from call to call.
class SparseAssignment {
 public:
  static constexpr std::int32_t kUnmatched = -1;

  /// The column of each row, or kUnmatched; valid until the next call. Pairs out of range or with a
  /// cost that is not finite or above `unmatched_cost` are left out; of pairs listed twice the
  /// cheapest counts. @pre rows, columns >= 0; unmatched_cost finite.
  std::span<const std::int32_t> solve(std::int32_t rows, std::int32_t columns,
                                      std::span<const CandidatePair> pairs, double unmatched_cost);

 private:
  struct Edge {
    std::int32_t column;
    double cost;
  };
  struct Label {
    double distance;
    std::int32_t column;
  };
  void build_edges(std::int32_t rows, std::int32_t columns, std::span<const CandidatePair> pairs,
                   double unmatched_cost);
  /// End of an augmenting path: a free column, or kUnmatched and the row that stays alone.
  struct PathEnd {
    std::int32_t column;
    std::int32_t row;
    double distance;
  };
  void relax_edges(std::int32_t row, double row_distance);
  void drop_outdated();
  [[nodiscard]] PathEnd find_path(std::int32_t start_row);
  void augment(std::int32_t start_row);

  double unmatched_cost_ = 0.0;
  std::vector<std::int32_t> first_edge_;  // of each row, and one past the last
  std::vector<Edge> edges_;
  std::vector<double> row_price_;
  std::vector<double> column_price_;
  std::vector<std::int32_t> column_of_row_;
  std::vector<std::int32_t> row_of_column_;
  std::vector<double> distance_;            // of each column, in the search at hand
  std::vector<std::int32_t> previous_row_;  // on the shortest path to each column
  std::vector<char> settled_;
  std::vector<std::int32_t> touched_;
  std::vector<std::int32_t> settled_order_;
  std::vector<Label> heap_;
};

}  // namespace furrow::tracking
