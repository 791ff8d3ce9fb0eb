#include "furrow_planning/upper_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "prepared_problem.hpp"

namespace furrow::planning {
namespace {

struct Cell {
  double x_m = 0.0;
  double y_m = 0.0;
  double early = 0.0;  ///< x - k y and x + k y with k = speed / velocity: in these coordinates a
  double late = 0.0;   ///< move is feasible when both grow by the margin
  std::uint32_t rank = 0;   ///< of `late`
  std::uint32_t reach = 0;  ///< how many ranks lie below late - margin
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool startable = false;
};

/// The greatest value so far in a range of ranks from 0, with where it stands.
class PrefixMaximum {
 public:
  void reset(std::size_t size) { tree_.assign(size + 1, {0.0, -1}); }
  void put(std::size_t rank, double value, std::int32_t index) {
    for (std::size_t i = rank + 1; i < tree_.size(); i += i & (~i + 1)) {
      if (value > tree_[i].value) {
        tree_[i] = {value, index};
      }
    }
  }
  struct Entry {
    double value = 0.0;
    std::int32_t index = -1;
  };
  [[nodiscard]] Entry below(std::size_t ranks) const {
    Entry best;
    for (std::size_t i = ranks; i > 0; i -= i & (~i + 1)) {
      if (tree_[i].value > best.value) {
        best = tree_[i];
      }
    }
    return best;
  }

 private:
  std::vector<Entry> tree_;
};

class Relaxation {
 public:
  Relaxation(const PreparedProblem& prepared, const PlannerParameters& parameters, double cell_m)
      : prepared_(prepared), cell_m_(cell_m) {
    double velocity = 0.0;
    double margin_s = std::numeric_limits<double>::infinity();
    for (const Start& start : prepared.starts) {
      if (start.usable) {
        ++axes_;
        velocity = std::max(velocity, start.transition.velocity_mps());
        margin_s = std::min(margin_s, start.transition.margin_s());
      }
    }
    slope_ = prepared.speed_mps / velocity;
    margin_m_ = prepared.speed_mps * margin_s - cell_m * (1.0 + slope_) - 1e-9;
    if (axes_ > 0 && margin_m_ > 0.0) {
      make_cells(treat_radius_m(parameters));
      sort_cells();
    }
  }

  /// False when the margin is too short for the grid: chains could then run in circles.
  [[nodiscard]] bool usable() const { return axes_ > 0 && margin_m_ > 0.0; }
  [[nodiscard]] std::size_t axes() const { return axes_; }

  /// The value of the best chain at the given prices, and how often it passes each node.
  double best_chain(const std::vector<double>& price, std::vector<int>& passes) {
    values_.assign(cells_.size(), 0.0);
    previous_.assign(cells_.size(), -1);
    prefix_.reset(cells_.size());
    std::size_t entered = 0;
    std::int32_t best = -1;
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const Cell& cell = cells_[c];
      for (; cells_[entered].early <= cell.early - margin_m_; ++entered) {
        if (values_[entered] > 0.0) {
          prefix_.put(cells_[entered].rank, values_[entered], static_cast<std::int32_t>(entered));
        }
      }
      double gain = 0.0;
      for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
        gain += prepared_.nodes[covers_[i]].weight - price[covers_[i]];
      }
      const auto before = prefix_.below(cell.reach);
      if (gain <= 0.0 || (before.index < 0 && !cell.startable)) {
        continue;
      }
      values_[c] = gain + before.value;
      previous_[c] = before.index;
      if (best < 0 || values_[c] > values_[static_cast<std::size_t>(best)]) {
        best = static_cast<std::int32_t>(c);
      }
    }
    passes.assign(prepared_.nodes.size(), 0);
    for (std::int32_t c = best; c >= 0; c = previous_[static_cast<std::size_t>(c)]) {
      const Cell& cell = cells_[static_cast<std::size_t>(c)];
      for (std::uint32_t i = cell.first; i < cell.first + cell.count; ++i) {
        ++passes[covers_[i]];
      }
    }
    return best < 0 ? 0.0 : values_[static_cast<std::size_t>(best)];
  }

 private:
  void make_cells(double radius_m) {
    // Any point of a cell is within half its diagonal of the centre.
    const double reach_m = radius_m + 0.5 * std::sqrt(2.0) * cell_m_ + 1e-9;
    std::vector<std::pair<std::int64_t, std::int64_t>> places;
    for (const Node& node : prepared_.nodes) {
      const auto index = [&](double value) {
        return static_cast<std::int64_t>(std::floor(value / cell_m_));
      };
      for (std::int64_t i = index(node.x_m - reach_m); i <= index(node.x_m + reach_m); ++i) {
        for (std::int64_t j = index(node.y_m - reach_m); j <= index(node.y_m + reach_m); ++j) {
          if (std::hypot(centre(i) - node.x_m, centre(j) - node.y_m) <= reach_m) {
            places.emplace_back(i, j);
          }
        }
      }
    }
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    const auto& nodes = prepared_.nodes;
    for (const auto& [i, j] : places) {
      Cell cell{.x_m = centre(i), .y_m = centre(j)};
      if (!any_start([&](const Start& start) {
            return cell.y_m >= start.lower_y_m - cell_m_ && cell.y_m <= start.upper_y_m + cell_m_;
          })) {
        continue;
      }
      cell.first = static_cast<std::uint32_t>(covers_.size());
      auto node = std::lower_bound(nodes.begin(), nodes.end(), cell.x_m - reach_m,
                                   [](const Node& n, double value) { return n.x_m < value; });
      for (; node != nodes.end() && node->x_m <= cell.x_m + reach_m; ++node) {
        if (std::hypot(node->x_m - cell.x_m, node->y_m - cell.y_m) <= reach_m) {
          covers_.push_back(static_cast<std::uint32_t>(node - nodes.begin()));
        }
      }
      cell.count = static_cast<std::uint32_t>(covers_.size()) - cell.first;
      cell.early = cell.x_m - slope_ * cell.y_m;
      cell.late = cell.x_m + slope_ * cell.y_m;
      cell.startable = any_start([&](const Start& start) {
        const double first_m = prepared_.speed_mps * std::min(start.transition.first_margin_s(),
                                                              start.transition.margin_s());
        return cell.x_m + cell_m_ - start.x_m >=
               first_m + slope_ * std::max(0.0, std::abs(cell.y_m - start.y_m) - cell_m_) - 1e-9;
      });
      cells_.push_back(cell);
    }
  }

  void sort_cells() {
    std::vector<double> late;
    for (const Cell& cell : cells_) {
      late.push_back(cell.late);
    }
    std::sort(late.begin(), late.end());
    late.erase(std::unique(late.begin(), late.end()), late.end());
    for (Cell& cell : cells_) {
      cell.rank = static_cast<std::uint32_t>(std::lower_bound(late.begin(), late.end(), cell.late) -
                                             late.begin());
      cell.reach = static_cast<std::uint32_t>(
          std::upper_bound(late.begin(), late.end(), cell.late - margin_m_) - late.begin());
    }
    std::sort(cells_.begin(), cells_.end(), [](const Cell& a, const Cell& b) {
      return a.early != b.early ? a.early < b.early : a.late < b.late;
    });
  }

  [[nodiscard]] double centre(std::int64_t index) const {
    return (static_cast<double>(index) + 0.5) * cell_m_;
  }
  template <class Predicate>
  [[nodiscard]] bool any_start(const Predicate& predicate) const {
    return std::any_of(prepared_.starts.begin(), prepared_.starts.end(),
                       [&](const Start& start) { return start.usable && predicate(start); });
  }

  const PreparedProblem& prepared_;
  double cell_m_;
  double slope_ = 0.0;
  double margin_m_ = 0.0;
  std::size_t axes_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> covers_;
  std::vector<double> values_;
  std::vector<std::int32_t> previous_;
  PrefixMaximum prefix_;
};

}  // namespace

Result<double> footprint_weight_bound(const PlanningProblem& problem,
                                      const PlannerParameters& parameters,
                                      const BoundEffort& effort) {
  if (!(effort.cell_m > 1e-4 && effort.cell_m < 1.0) || effort.iterations < 0) {
    return Error{ErrorCode::kInvalidArgument, "the effort for the bound is not sound"};
  }
  if (problem.speeds != nullptr) {
    return Error{ErrorCode::kInvalidArgument, "the bound is for a constant speed"};
  }
  PreparedProblem prepared;
  Plan scratch;
  if (Status status = prepare(problem, parameters, treat_radius_m(parameters), prepared, scratch);
      !status) {
    return status.error();
  }
  double all = 0.0;
  double greatest = 0.0;
  for (const Node& node : prepared.nodes) {
    all += node.weight;
    greatest = std::max(greatest, node.weight);
  }
  Relaxation relaxation(prepared, parameters, effort.cell_m);
  if (!relaxation.usable()) {
    return all;
  }
  double bound = all;
  const auto axes = static_cast<double>(relaxation.axes());
  std::vector<double> price(prepared.nodes.size(), 0.0);
  for (std::size_t k = 0; k < price.size(); ++k) {
    price[k] = 0.8 * prepared.nodes[k].weight;
  }
  std::vector<int> passes;
  for (std::int64_t iteration = 0; iteration < effort.iterations; ++iteration) {
    double value = axes * relaxation.best_chain(price, passes);
    for (const double p : price) {
      value += p;
    }
    bound = std::min(bound, value);
    const double step = 0.1 * greatest / (1.0 + 0.2 * static_cast<double>(iteration));
    for (std::size_t k = 0; k < price.size(); ++k) {
      price[k] =
          std::clamp(price[k] + step * (axes * passes[k] - 1.0), 0.0, prepared.nodes[k].weight);
    }
  }
  return bound;
}

}  // namespace furrow::planning
