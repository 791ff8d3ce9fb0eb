#include "furrow_tracking/assignment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace furrow::tracking {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Order of the heap: nearest first, then lowest column.
constexpr auto later = [](const auto& a, const auto& b) {
  return a.distance != b.distance ? a.distance > b.distance : a.column > b.column;
};

}  // namespace

void SparseAssignment::build_edges(std::int32_t rows, std::int32_t columns,
                                   std::span<const CandidatePair> pairs, double unmatched_cost) {
  const auto usable = [&](const CandidatePair& pair) {
    return pair.row >= 0 && pair.row < rows && pair.column >= 0 && pair.column < columns &&
           std::isfinite(pair.cost) && pair.cost <= unmatched_cost;
  };
  first_edge_.assign(static_cast<std::size_t>(rows) + 1, 0);
  for (const CandidatePair& pair : pairs) {
    if (usable(pair)) ++first_edge_[pair.row + 1];
  }
  for (std::int32_t row = 0; row < rows; ++row) first_edge_[row + 1] += first_edge_[row];
  edges_.resize(static_cast<std::size_t>(first_edge_[rows]));
  // Filling moves each row's start to its end, which is the next row's start; shifted back below.
  for (const CandidatePair& pair : pairs) {
    if (usable(pair)) edges_[first_edge_[pair.row]++] = {pair.column, pair.cost};
  }
  for (std::int32_t row = rows; row > 0; --row) first_edge_[row] = first_edge_[row - 1];
  first_edge_[0] = 0;
}

std::span<const std::int32_t> SparseAssignment::solve(std::int32_t rows, std::int32_t columns,
                                                      std::span<const CandidatePair> pairs,
                                                      double unmatched_cost) {
  build_edges(rows, columns, pairs, unmatched_cost);
  unmatched_cost_ = unmatched_cost;
  column_of_row_.assign(static_cast<std::size_t>(rows), kUnmatched);
  row_of_column_.assign(static_cast<std::size_t>(columns), kUnmatched);
  column_price_.assign(static_cast<std::size_t>(columns), 0.0);
  distance_.assign(static_cast<std::size_t>(columns), kInfinity);
  previous_row_.assign(static_cast<std::size_t>(columns), kUnmatched);
  settled_.assign(static_cast<std::size_t>(columns), 0);
  row_price_.assign(static_cast<std::size_t>(rows), unmatched_cost);
  for (std::int32_t row = 0; row < rows; ++row) {
    for (std::int32_t e = first_edge_[row]; e < first_edge_[row + 1]; ++e) {
      row_price_[row] = std::min(row_price_[row], edges_[e].cost);
    }
  }
  for (std::int32_t row = 0; row < rows; ++row) augment(row);
  return column_of_row_;
}

void SparseAssignment::relax_edges(std::int32_t row, double row_distance) {
  for (std::int32_t e = first_edge_[row]; e < first_edge_[row + 1]; ++e) {
    const std::int32_t column = edges_[e].column;
    if (settled_[column] != 0) continue;
    const double distance = row_distance + edges_[e].cost - row_price_[row] - column_price_[column];
    if (distance >= distance_[column]) continue;
    if (distance_[column] == kInfinity) touched_.push_back(column);
    distance_[column] = distance;
    previous_row_[column] = row;
    heap_.push_back({distance, column});
    std::push_heap(heap_.begin(), heap_.end(), later);
  }
}

void SparseAssignment::drop_outdated() {
  while (!heap_.empty() && (settled_[heap_.front().column] != 0 ||
                            heap_.front().distance > distance_[heap_.front().column])) {
    std::pop_heap(heap_.begin(), heap_.end(), later);
    heap_.pop_back();
  }
}

SparseAssignment::PathEnd SparseAssignment::find_path(std::int32_t start_row) {
  touched_.clear();
  settled_order_.clear();
  heap_.clear();

  // Each row may also end alone, at a column of its own that costs unmatched_cost.
  PathEnd alone{kUnmatched, start_row, kInfinity};
  std::int32_t row = start_row;
  double row_distance = 0.0;
  while (true) {
    const double alone_distance = row_distance + unmatched_cost_ - row_price_[row];
    if (alone_distance < alone.distance) alone = {kUnmatched, row, alone_distance};
    relax_edges(row, row_distance);
    drop_outdated();
    if (heap_.empty() || alone.distance <= heap_.front().distance) return alone;
    const Label nearest = heap_.front();
    if (row_of_column_[nearest.column] == kUnmatched) {
      return {nearest.column, start_row, nearest.distance};
    }
    settled_[nearest.column] = 1;
    settled_order_.push_back(nearest.column);
    row = row_of_column_[nearest.column];
    row_distance = nearest.distance;
  }
}

void SparseAssignment::augment(std::int32_t start_row) {
  const PathEnd end = find_path(start_row);
  row_price_[start_row] += end.distance;
  for (const std::int32_t column : settled_order_) {
    const double slack = end.distance - distance_[column];
    column_price_[column] -= slack;
    row_price_[row_of_column_[column]] += slack;
  }
  std::int32_t end_column = end.column;
  if (end_column == kUnmatched) {
    end_column = column_of_row_[end.row];
    column_of_row_[end.row] = kUnmatched;
  }
  // Along the path each row gives its column to the row before it and takes the next one.
  while (end_column != kUnmatched) {
    const std::int32_t taker = previous_row_[end_column];
    const std::int32_t freed = column_of_row_[taker];
    column_of_row_[taker] = end_column;
    row_of_column_[end_column] = taker;
    end_column = taker == start_row ? kUnmatched : freed;
  }
  for (const std::int32_t column : touched_) {
    distance_[column] = kInfinity;
    settled_[column] = 0;
  }
}

}  // namespace furrow::tracking
