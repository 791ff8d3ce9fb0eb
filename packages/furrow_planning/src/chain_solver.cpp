#include "chain_solver.hpp"

#include <algorithm>

namespace furrow::planning {

void ChainSolver::pass(std::size_t i) {
  const Label& passed = labels_[i];
  if (passed.score > far_score_) {
    far_score_ = passed.score;
    best_far_.clear();
  }
  if (passed.score >= 0 && passed.score == far_score_) {
    best_far_.push_back(static_cast<std::uint32_t>(i));
  }
}

void ChainSolver::label_member(const PreparedProblem& prepared, const Start& start,
                               std::span<const std::uint32_t> members, std::size_t near,
                               std::size_t k) {
  const auto node = [&](std::size_t i) -> const Node& { return prepared.nodes[members[i]]; };
  const Node& to = node(k);
  Label& label = labels_[k];
  const auto offer = [&](std::int64_t score, std::int64_t travel, std::int32_t previous) {
    if (score > label.score || (score == label.score && travel < label.travel)) {
      label = {score, travel, previous};
    }
  };
  if (start.reaches(to.x_m, to.y_m)) {
    offer(0, prepared.scoring.travel(to.y_m - start.y_m), -1);
  }
  const auto follow = [&](std::size_t j) {
    offer(labels_[j].score, labels_[j].travel + prepared.scoring.travel(to.y_m - node(j).y_m),
          static_cast<std::int32_t>(j));
  };
  for (const std::uint32_t j : best_far_) follow(j);
  for (std::size_t j = near; j < k; ++j) {
    if (labels_[j].score >= label.score && labels_[j].score >= 0 &&
        start.follows(node(j).x_m, node(j).y_m, to.x_m, to.y_m)) {
      follow(j);
    }
  }
  if (label.score >= 0) label.score += to.score;
}

void ChainSolver::solve(const PreparedProblem& prepared, const Start& start,
                        std::span<const std::uint32_t> members, std::vector<std::uint32_t>& chain) {
  chain.clear();
  labels_.assign(members.size(), Label{});
  best_far_.clear();
  far_score_ = -1;
  const auto node = [&](std::size_t i) -> const Node& { return prepared.nodes[members[i]]; };
  const double always_dx_m = start.transition.needed_dx_m(start.upper_y_m - start.lower_y_m);
  std::size_t near = 0;
  std::int64_t best_score = 0;
  std::int64_t best_travel = 0;
  std::int32_t best_end = -1;
  for (std::size_t k = 0; k < members.size(); ++k) {
    if (!start.spans(node(k).y_m)) continue;
    for (; near < k && node(k).x_m - node(near).x_m >= always_dx_m; ++near) pass(near);
    label_member(prepared, start, members, near, k);
    const Label& end = labels_[k];
    if (end.score < 0) continue;
    if (end.score > best_score || (end.score == best_score && end.travel < best_travel)) {
      best_score = end.score;
      best_travel = end.travel;
      best_end = static_cast<std::int32_t>(k);
    }
  }
  for (std::int32_t k = best_end; k >= 0; k = labels_[static_cast<std::size_t>(k)].previous) {
    chain.push_back(members[static_cast<std::size_t>(k)]);
  }
  std::reverse(chain.begin(), chain.end());
}

}  // namespace furrow::planning
