#include "axis_routes.hpp"

#include <algorithm>
#include <cmath>

#include "chain_solver.hpp"

namespace furrow::planning {
namespace {

/// The state of an axis that has just sprayed at a node.
Start at_node(const Start& start, const Node& node) {
  Start next = start;
  next.x_m = node.x_m;
  next.y_m = node.y_m;
  next.after_spray = true;
  return next;
}

class GreedyRouter final : public AxisRouter {
 public:
  void route(const PreparedProblem& prepared, const Start& start,
             std::span<const std::uint32_t> members, std::vector<std::uint32_t>& chain) override {
    chain.clear();
    Start at = start;
    for (const std::uint32_t k : members) {
      const Node& node = prepared.nodes[k];
      if (at.spans(node.y_m) && at.reaches(node.x_m, node.y_m)) {
        chain.push_back(k);
        at = at_node(at, node);
      }
    }
  }
};

class NotspRouter final : public AxisRouter {
 public:
  explicit NotspRouter(std::size_t n) : n_(n) {}

  void route(const PreparedProblem& prepared, const Start& start,
             std::span<const std::uint32_t> members, std::vector<std::uint32_t>& chain) override {
    chain.clear();
    Start at = start;
    std::size_t first = 0;
    while (true) {
      nearest_.clear();
      while (first < members.size() && prepared.nodes[members[first]].x_m <= at.x_m) {
        ++first;
      }
      gather(prepared, at, members.subspan(first));
      if (nearest_.empty()) {
        return;
      }
      window_.clear();
      for (const Near& near : nearest_) {
        window_.push_back(near.node);
      }
      std::sort(window_.begin(), window_.end());
      solver_.solve(prepared, at, window_, tour_);
      if (tour_.empty()) {
        return;
      }
      chain.push_back(tour_.front());
      at = at_node(at, prepared.nodes[tour_.front()]);
    }
  }

 private:
  struct Near {
    double distance_m = 0.0;
    std::uint32_t node = 0;
    bool operator<(const Near& other) const {
      return distance_m != other.distance_m ? distance_m < other.distance_m : node < other.node;
    }
  };

  void gather(const PreparedProblem& prepared, const Start& at,
              std::span<const std::uint32_t> members) {
    for (const std::uint32_t k : members) {
      const Node& node = prepared.nodes[k];
      if (nearest_.size() == n_ && node.x_m - at.x_m > nearest_.back().distance_m) {
        return;
      }
      if (!at.spans(node.y_m) || !at.reaches(node.x_m, node.y_m)) {
        continue;
      }
      const Near near{std::hypot(node.x_m - at.x_m, node.y_m - at.y_m), k};
      nearest_.insert(std::upper_bound(nearest_.begin(), nearest_.end(), near), near);
      if (nearest_.size() > n_) {
        nearest_.pop_back();
      }
    }
  }

  std::size_t n_;
  ChainSolver solver_;
  std::vector<Near> nearest_;
  std::vector<std::uint32_t> window_;
  std::vector<std::uint32_t> tour_;
};

class PermutationRouter final : public AxisRouter {
 public:
  PermutationRouter(std::size_t n, double omega) : n_(n), omega_(omega) {}

  void route(const PreparedProblem& prepared, const Start& start,
             std::span<const std::uint32_t> members, std::vector<std::uint32_t>& chain) override {
    chain.clear();
    Start at = start;
    for (std::size_t first = 0; first < members.size(); first += n_) {
      const auto block = members.subspan(first, std::min(n_, members.size() - first));
      best_.clear();
      best_score_ = 0;
      best_mean_gamma_ = 0.0;
      current_.clear();
      extend(prepared, at, block, 0, 0, 0.0);
      for (const std::uint32_t k : best_) {
        chain.push_back(k);
        at = at_node(at, prepared.nodes[k]);
      }
    }
  }

 private:
  void extend(const PreparedProblem& prepared, const Start& at,
              std::span<const std::uint32_t> block, std::uint32_t used, std::int64_t score,
              double gamma_sum) {
    if (!current_.empty()) {
      const double mean_gamma = gamma_sum / static_cast<double>(current_.size());
      if (score > best_score_ || (score == best_score_ && mean_gamma > best_mean_gamma_)) {
        best_ = current_;
        best_score_ = score;
        best_mean_gamma_ = mean_gamma;
      }
    }
    for (std::size_t i = 0; i < block.size(); ++i) {
      const Node& node = prepared.nodes[block[i]];
      if ((used >> i & 1U) != 0U || !at.spans(node.y_m) || !at.reaches(node.x_m, node.y_m)) {
        continue;
      }
      const double spare_s = (at.way_m(node.x_m) - at.way_m(at.x_m)) / prepared.speed_mps -
                             at.transition.move_s(node.y_m - at.y_m);
      current_.push_back(block[i]);
      extend(prepared, at_node(at, node), block, used | 1U << i, score + node.score,
             gamma_sum + feasibility(spare_s, omega_));
      current_.pop_back();
    }
  }

  std::size_t n_;
  double omega_;
  std::vector<std::uint32_t> current_;
  std::vector<std::uint32_t> best_;
  std::int64_t best_score_ = 0;
  double best_mean_gamma_ = 0.0;
};

class ExactRouter final : public AxisRouter {
 public:
  void route(const PreparedProblem& prepared, const Start& start,
             std::span<const std::uint32_t> members, std::vector<std::uint32_t>& chain) override {
    solver_.solve(prepared, start, members, chain);
  }

 private:
  ChainSolver solver_;
};

}  // namespace

std::unique_ptr<AxisRouter> make_greedy_router() {
  return std::make_unique<GreedyRouter>();
}
std::unique_ptr<AxisRouter> make_notsp_router(std::size_t n) {
  return std::make_unique<NotspRouter>(n);
}
std::unique_ptr<AxisRouter> make_permutation_router(std::size_t n, double omega) {
  return std::make_unique<PermutationRouter>(n, omega);
}
std::unique_ptr<AxisRouter> make_exact_router() {
  return std::make_unique<ExactRouter>();
}

}  // namespace furrow::planning
