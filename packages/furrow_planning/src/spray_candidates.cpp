#include "spray_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace furrow::planning {
namespace {

constexpr std::size_t kMostNeighbours = 10;  ///< of a stem, that are paired with it
constexpr double kInside = 0.999;            ///< of the radius: places at the rim stay inside it
constexpr double kShifts[] = {0.0, -0.5, 0.5, -0.95, 0.95};  ///< along the travel, of the radius

double squared(double dx, double dy) {
  return dx * dx + dy * dy;
}

}  // namespace

void SprayCandidates::build(const PlanningProblem& problem, const PlannerParameters& parameters,
                            const PreparedProblem& prepared, double from_x_m,
                            std::span<const Eigen::Vector2d> extra) {
  prepared_ = &prepared;
  radius_m_ = treat_radius_m(parameters);
  centre_preference_ = parameters.centre_preference;
  lower_y_m_ = std::numeric_limits<double>::infinity();
  upper_y_m_ = -lower_y_m_;
  for (const Start& start : prepared.starts) {
    if (start.usable) {
      lower_y_m_ = std::min(lower_y_m_, start.lower_y_m);
      upper_y_m_ = std::max(upper_y_m_, start.upper_y_m);
    }
  }
  sort_zones(problem, parameters);
  sprays_.clear();
  covers_.clear();
  const auto& nodes = prepared.nodes;
  coverable_.assign(nodes.size(), 0);
  const double reach_m = 2.0 * radius_m_ * kInside;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].x_m < from_x_m) {
      continue;
    }
    offer_single(nodes[i]);
    offer_beside_zones(nodes[i]);
    std::size_t neighbours = 0;
    for (std::size_t j = i + 1;
         j < nodes.size() && nodes[j].x_m - nodes[i].x_m <= reach_m && neighbours < kMostNeighbours;
         ++j) {
      if (squared(nodes[j].x_m - nodes[i].x_m, nodes[j].y_m - nodes[i].y_m) > reach_m * reach_m) {
        continue;
      }
      ++neighbours;
      offer_pair(nodes[i], nodes[j]);
      for (std::size_t k = j + 1; k < std::min(nodes.size(), j + kMostNeighbours) &&
                                  nodes[k].x_m - nodes[i].x_m <= reach_m;
           ++k) {
        offer_triple(nodes[i], nodes[j], nodes[k]);
      }
    }
  }
  for (const Eigen::Vector2d& aim : extra) {
    if (aim.x() >= from_x_m) {
      offer(aim.x(), aim.y());
    }
  }
  std::sort(sprays_.begin(), sprays_.end(), [](const Spray& a, const Spray& b) {
    if (a.x_m != b.x_m) {
      return a.x_m < b.x_m;
    }
    return a.y_m != b.y_m ? a.y_m < b.y_m : a.first < b.first;
  });
}

void SprayCandidates::sort_zones(const PlanningProblem& problem,
                                 const PlannerParameters& parameters) {
  zones_.clear();
  widest_zone_m_ = 0.0;
  for (const ProtectedPlant& plant : problem.protected_plants) {
    const double radius_m = keep_out_m(parameters, plant);
    zones_.push_back({plant.p_F.x(), plant.p_F.y(), radius_m});
    widest_zone_m_ = std::max(widest_zone_m_, radius_m);
  }
  std::sort(zones_.begin(), zones_.end(), [](const Zone& a, const Zone& b) {
    return a.x_m != b.x_m ? a.x_m < b.x_m : a.y_m < b.y_m;
  });
}

bool SprayCandidates::allowed(double x_m, double y_m) const {
  const auto first =
      std::lower_bound(zones_.begin(), zones_.end(), x_m - widest_zone_m_,
                       [](const Zone& zone, double value) { return zone.x_m < value; });
  for (auto zone = first; zone != zones_.end() && zone->x_m <= x_m + widest_zone_m_; ++zone) {
    if (squared(zone->x_m - x_m, zone->y_m - y_m) < zone->radius_m * zone->radius_m) {
      return false;
    }
  }
  return true;
}

void SprayCandidates::offer(double x_m, double y_m) {
  if (y_m < lower_y_m_ || y_m > upper_y_m_ || !allowed(x_m, y_m)) {
    return;
  }
  const auto& nodes = prepared_->nodes;
  Spray spray{.x_m = x_m, .y_m = y_m, .first = static_cast<std::uint32_t>(covers_.size())};
  auto node = std::lower_bound(nodes.begin(), nodes.end(), x_m - radius_m_,
                               [](const Node& n, double value) { return n.x_m < value; });
  for (; node != nodes.end() && node->x_m <= x_m + radius_m_; ++node) {
    const double d2 = squared(node->x_m - x_m, node->y_m - y_m);
    if (d2 <= radius_m_ * radius_m_) {
      const double share = 1.0 - centre_preference_ * d2 / (radius_m_ * radius_m_);
      const auto index = static_cast<std::uint32_t>(node - nodes.begin());
      covers_.push_back({index, std::max<std::int64_t>(
                                    1, std::llround(share * static_cast<double>(node->score)))});
      coverable_[index] = 1;
    }
  }
  spray.count = static_cast<std::uint32_t>(covers_.size()) - spray.first;
  if (spray.count > 0) {
    sprays_.push_back(spray);
  }
}

void SprayCandidates::offer_single(const Node& node) {
  const double y_m = std::clamp(node.y_m, lower_y_m_, upper_y_m_);
  const double aside_m = node.y_m - y_m;
  if (std::abs(aside_m) > kInside * radius_m_) {
    return;
  }
  const double along_m = std::sqrt(std::max(0.0, radius_m_ * radius_m_ - aside_m * aside_m));
  for (const double shift : kShifts) {
    offer(node.x_m + shift * along_m, y_m);
  }
}

void SprayCandidates::offer_pair(const Node& a, const Node& b) {
  const double r = kInside * radius_m_;
  const double mx = 0.5 * (a.x_m + b.x_m);
  const double my = 0.5 * (a.y_m + b.y_m);
  offer(mx, my);
  const double dx = b.x_m - a.x_m;
  const double dy = b.y_m - a.y_m;
  const double d = std::sqrt(squared(dx, dy));
  if (d <= 0.0) {
    return;
  }
  // Both stems are within the radius in a lens. Along the travel it ends at the end of one circle
  // if that lies in the other, else at a crossing of the two.
  const double h = std::sqrt(std::max(0.0, r * r - 0.25 * d * d));
  const double cross_x = h * std::abs(dy) / d;
  const double cross_y = -h * dx / d * (dy < 0.0 ? -1.0 : 1.0);
  if (squared(a.x_m + r - b.x_m, dy) <= r * r) {
    offer(a.x_m + r, a.y_m);
  } else {
    offer(mx + cross_x, my + cross_y);
  }
  if (squared(b.x_m - r - a.x_m, dy) <= r * r) {
    offer(b.x_m - r, b.y_m);
  } else {
    offer(mx - cross_x, my - cross_y);
  }
}

void SprayCandidates::offer_triple(const Node& a, const Node& b, const Node& c) {
  const double reach = 2.0 * kInside * radius_m_;
  if (squared(c.x_m - a.x_m, c.y_m - a.y_m) > reach * reach ||
      squared(c.x_m - b.x_m, c.y_m - b.y_m) > reach * reach) {
    return;
  }
  // The circumcentre; of an obtuse triangle a pair's middle serves, which is offered already.
  const double bx = b.x_m - a.x_m;
  const double by = b.y_m - a.y_m;
  const double cx = c.x_m - a.x_m;
  const double cy = c.y_m - a.y_m;
  const double twice = 2.0 * (bx * cy - by * cx);
  if (std::abs(twice) < 1e-12) {
    return;
  }
  const double b2 = squared(bx, by);
  const double c2 = squared(cx, cy);
  const double ux = (cy * b2 - by * c2) / twice;
  const double uy = (bx * c2 - cx * b2) / twice;
  if (squared(ux, uy) <= kInside * kInside * radius_m_ * radius_m_) {
    offer(a.x_m + ux, a.y_m + uy);
  }
}

void SprayCandidates::offer_beside_zones(const Node& node) {
  const double far_m = widest_zone_m_ + radius_m_;
  const auto first =
      std::lower_bound(zones_.begin(), zones_.end(), node.x_m - far_m,
                       [](const Zone& zone, double value) { return zone.x_m < value; });
  for (auto zone = first; zone != zones_.end() && zone->x_m <= node.x_m + far_m; ++zone) {
    const double dx = node.x_m - zone->x_m;
    const double dy = node.y_m - zone->y_m;
    const double d = std::sqrt(squared(dx, dy));
    const double out_m = zone->radius_m + 1e-7;
    if (d > out_m || d <= 0.0 || out_m - d > radius_m_) {
      continue;
    }
    offer(zone->x_m + dx / d * out_m, zone->y_m + dy / d * out_m);
  }
}

}  // namespace furrow::planning
