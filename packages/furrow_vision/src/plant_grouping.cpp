#include "plant_grouping.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <unordered_map>

namespace furrow::vision {
namespace {

class UnionFind {
 public:
  explicit UnionFind(int size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int a, int b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

struct Piece {
  int area_px = 0;
  cv::Rect box;
};

/// Joins pieces that are neighbours in the Voronoi sense and near for the size of the smaller one.
void join_pieces(const cv::Mat& labels, const std::vector<Piece>& pieces,
                 const GroupingParameters& parameters, UnionFind& groups) {
  cv::Mat distance, nearest;
  const cv::Mat background = labels == 0;
  cv::distanceTransform(background, distance, nearest, cv::DIST_L2, cv::DIST_MASK_5,
                        cv::DIST_LABEL_CCOMP);
  // The distance transform numbers the pieces on its own.
  std::vector<int> piece_of(pieces.size() + 1, 0);
  for (int v = 0; v < labels.rows; ++v) {
    const int* label = labels.ptr<int>(v);
    const int* own = nearest.ptr<int>(v);
    for (int u = 0; u < labels.cols; ++u) {
      if (label[u] != 0 && own[u] < static_cast<int>(piece_of.size())) piece_of[own[u]] = label[u];
    }
  }
  const auto join_across = [&](int v, int u, int dv, int du) {
    const int a = piece_of[nearest.at<int>(v, u)];
    const int b = piece_of[nearest.at<int>(v + dv, u + du)];
    if (a == b || a == 0 || b == 0) return;
    const double gap = distance.at<float>(v, u) + distance.at<float>(v + dv, u + du);
    const double size = std::sqrt(std::min(pieces[a].area_px, pieces[b].area_px));
    const double allowed =
        std::min(parameters.merge_gap_max_px,
                 parameters.merge_gap_min_px + parameters.merge_gap_factor * size);
    if (gap <= allowed) groups.unite(a, b);
  };
  const auto reach = static_cast<float>(parameters.merge_gap_max_px);
  for (int v = 0; v + 1 < labels.rows; ++v) {
    const float* d = distance.ptr<float>(v);
    for (int u = 0; u + 1 < labels.cols; ++u) {
      if (d[u] > reach) continue;
      join_across(v, u, 0, 1);
      join_across(v, u, 1, 0);
    }
  }
}

struct Peak {
  cv::Point at;
  float height = 0.0f;
};

/// Floods the height map downwards from its peaks; basins that meet at a saddle that is high for
/// the lower of their peaks become one. Gives each pixel above zero its basin, from 1.
class PeakFlood {
 public:
  PeakFlood(const cv::Mat& height, double saddle_ratio)
      : height_(height), basins_(cv::Mat::zeros(height.size(), CV_32S)) {
    std::vector<cv::Point> order;
    for (int v = 0; v < height.rows; ++v) {
      const float* row = height.ptr<float>(v);
      for (int u = 0; u < height.cols; ++u) {
        if (row[u] > 0.0f) order.emplace_back(u, v);
      }
    }
    std::stable_sort(order.begin(), order.end(), [&](const cv::Point& a, const cv::Point& b) {
      return height.at<float>(a) > height.at<float>(b);
    });
    peaks_.push_back({});
    parent_.push_back(0);
    for (const cv::Point& p : order) place(p, saddle_ratio);
  }

  [[nodiscard]] int basin(const cv::Point& p) { return find(basins_.at<int>(p)); }
  [[nodiscard]] const Peak& peak(int basin) const { return peaks_[basin]; }

 private:
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void place(const cv::Point& p, double saddle_ratio) {
    const float h = height_.at<float>(p);
    int own = 0;
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const cv::Point q(p.x + du, p.y + dv);
        if (!cv::Rect(cv::Point(), height_.size()).contains(q)) continue;
        const int other = basin(q);
        if (other == 0 || other == own) continue;
        if (own == 0) {
          own = other;
          continue;
        }
        const int low = peaks_[own].height < peaks_[other].height ? own : other;
        const int high = low == own ? other : own;
        if (h >= saddle_ratio * peaks_[low].height) {
          parent_[low] = high;
          own = high;
        } else if (peaks_[other].height > peaks_[own].height) {
          own = other;
        }
      }
    }
    if (own == 0) {
      own = static_cast<int>(peaks_.size());
      peaks_.push_back({p, h});
      parent_.push_back(own);
    }
    basins_.at<int>(p) = own;
  }

  const cv::Mat& height_;
  cv::Mat basins_;
  std::vector<Peak> peaks_;
  std::vector<int> parent_;
};

/// Where the stem is likely: the densest place of the canopy, by mean shift from its centroid with
/// a Gauss kernel that grows with the plant. Leaves around a bare stem draw it to their middle, and
/// a single long leaf less than it draws the centroid.
Eigen::Vector2d stem_of(const std::vector<Eigen::Vector2d>& pixels, double kernel_factor) {
  constexpr int kRounds = 8;
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  for (const auto& p : pixels) centre += p;
  centre /= static_cast<double>(pixels.size());
  const double sd = std::max(1.0, kernel_factor * std::sqrt(static_cast<double>(pixels.size())));
  // A large canopy tells its centre from a part of its pixels as well.
  const std::size_t step = 1 + pixels.size() / 2000;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double weights = 0.0;
    for (std::size_t i = 0; i < pixels.size(); i += step) {
      const double weight = std::exp(-0.5 * (pixels[i] - centre).squaredNorm() / (sd * sd));
      sum += weight * pixels[i];
      weights += weight;
    }
    const Eigen::Vector2d next = sum / weights;
    const bool settled = (next - centre).norm() < 0.02;
    centre = next;
    if (settled) break;
  }
  return centre;
}

/// One basin of a group's height map, and the pixels of vegetation in it.
struct Basin {
  int id = 0;
  Peak peak;
  int part = 0;  ///< the connected part of the closed canopy that it lies in
  std::vector<Eigen::Vector2d> pixels;
};

/// Which basins are plants of their own: the highest; and those of enough area that a saddle parts
/// from one in the same connected part. The others, leaves by themselves, go to the nearest plant.
/// Gives for each basin that of its plant. Basins come in the order of height.
std::vector<std::size_t> plants_of_basins(const std::vector<Basin>& basins, double min_area_px) {
  std::vector<std::size_t> kept, plant_of(basins.size());
  for (std::size_t i = 0; i < basins.size(); ++i) {
    const bool parted = std::any_of(
        kept.begin(), kept.end(), [&](std::size_t k) { return basins[k].part == basins[i].part; });
    if (kept.empty() || (parted && static_cast<double>(basins[i].pixels.size()) >= min_area_px)) {
      kept.push_back(i);
    }
  }
  for (std::size_t i = 0; i < basins.size(); ++i) {
    const auto distance = [&](std::size_t k) {
      return cv::norm(basins[k].peak.at - basins[i].peak.at);
    };
    plant_of[i] = *std::min_element(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
      return distance(a) < distance(b);
    });
  }
  return plant_of;
}

/// The basins that hold vegetation, and for each pixel of `own` its basin's index + 1.
std::vector<Basin> collect_basins(const cv::Mat& own, const cv::Mat& closed,
                                  const cv::Point& offset, PeakFlood& flood, cv::Mat& index) {
  cv::Mat parts;
  cv::connectedComponents(closed, parts, 8, CV_32S);
  std::vector<Basin> basins;
  std::unordered_map<int, std::size_t> at;
  index = cv::Mat::zeros(own.size(), CV_32S);
  for (int v = 0; v < own.rows; ++v) {
    for (int u = 0; u < own.cols; ++u) {
      if (own.at<std::uint8_t>(v, u) == 0) continue;
      const int id = flood.basin({u, v});
      const auto [found, added] = at.emplace(id, basins.size());
      if (added) basins.push_back({id, flood.peak(id), parts.at<int>(v, u), {}});
      basins[found->second].pixels.emplace_back(u + offset.x, v + offset.y);
      index.at<int>(v, u) = static_cast<int>(found->second) + 1;
    }
  }
  return basins;
}

/// Sorts basins by falling height of their peak; returns the new place of each.
std::vector<std::size_t> sort_by_height(std::vector<Basin>& basins) {
  std::vector<std::size_t> order(basins.size()), place(basins.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t k) {
    return basins[i].peak.height > basins[k].peak.height;
  });
  std::vector<Basin> sorted;
  for (std::size_t i = 0; i < order.size(); ++i) {
    place[order[i]] = i;
    sorted.push_back(std::move(basins[order[i]]));
  }
  basins = std::move(sorted);
  return place;
}

void split_group(const cv::Mat& labels, const std::vector<int>& group_of, int group,
                 const Piece& extent, const GroupingParameters& parameters, PlantGroups& plants) {
  const double closing = parameters.closing_factor * std::sqrt(extent.area_px);
  const int margin = static_cast<int>(std::ceil(3.0 * closing)) + 2;
  const cv::Rect roi(extent.box.x - margin, extent.box.y - margin, extent.box.width + 2 * margin,
                     extent.box.height + 2 * margin);
  cv::Mat own = cv::Mat::zeros(roi.size(), CV_8U);
  for (int v = extent.box.y; v < extent.box.y + extent.box.height; ++v) {
    const int* label = labels.ptr<int>(v);
    auto* row = own.ptr<std::uint8_t>(v - roi.y);
    for (int u = extent.box.x; u < extent.box.x + extent.box.width; ++u) {
      if (label[u] != 0 && group_of[label[u]] == group) row[u - roi.x] = 255;
    }
  }
  cv::Mat closed;
  if (closing > 0.3) {
    cv::GaussianBlur(own, closed, {}, closing, closing, cv::BORDER_CONSTANT);
    closed = (closed > 90) | own;
  } else {
    closed = own;
  }
  cv::Mat height;
  cv::distanceTransform(closed, height, cv::DIST_L2, cv::DIST_MASK_5);
  cv::GaussianBlur(height, height, {}, std::max(0.8, 0.5 * closing));
  height.setTo(0.0f, closed == 0);
  PeakFlood flood(height, parameters.split_saddle_ratio);

  cv::Mat index;
  std::vector<Basin> sorted = collect_basins(own, closed, roi.tl(), flood, index);
  const std::vector<std::size_t> place = sort_by_height(sorted);
  const auto plant_of = plants_of_basins(sorted, parameters.split_min_area_px);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (plant_of[i] == i) continue;
    auto& into = sorted[plant_of[i]].pixels;
    into.insert(into.end(), sorted[i].pixels.begin(), sorted[i].pixels.end());
  }
  std::vector<int> plant_label(sorted.size(), 0);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    if (plant_of[i] != i) continue;
    if (static_cast<double>(sorted[i].pixels.size()) < parameters.min_area_px) continue;
    if (static_cast<int>(plants.stem_px.size()) >= parameters.max_plants) break;
    plants.stem_px.push_back(stem_of(sorted[i].pixels, parameters.stem_kernel_factor));
    plant_label[i] = static_cast<int>(plants.stem_px.size());
  }
  std::vector<int> label_of(sorted.size() + 1, 0);
  for (std::size_t i = 0; i < place.size(); ++i) label_of[i + 1] = plant_label[plant_of[place[i]]];
  for (int v = extent.box.y; v < extent.box.y + extent.box.height; ++v) {
    const int* from = index.ptr<int>(v - roi.y);
    int* to = plants.labels.ptr<int>(v);
    for (int u = extent.box.x; u < extent.box.x + extent.box.width; ++u) {
      if (from[u - roi.x] != 0) to[u] = label_of[from[u - roi.x]];
    }
  }
}

}  // namespace

PlantGroups group_plants(const cv::Mat& mask, const GroupingParameters& parameters) {
  PlantGroups plants{cv::Mat::zeros(mask.size(), CV_32S), {}};
  cv::Mat labels, stats, centroids;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 8, CV_32S);
  if (count <= 1) return plants;
  std::vector<Piece> pieces(count);
  for (int i = 1; i < count; ++i) {
    pieces[i].area_px = stats.at<int>(i, cv::CC_STAT_AREA);
    pieces[i].box = {stats.at<int>(i, cv::CC_STAT_LEFT), stats.at<int>(i, cv::CC_STAT_TOP),
                     stats.at<int>(i, cv::CC_STAT_WIDTH), stats.at<int>(i, cv::CC_STAT_HEIGHT)};
  }
  UnionFind groups(count);
  join_pieces(labels, pieces, parameters, groups);
  std::vector<int> group_of(count, 0);
  std::vector<Piece> extents(count);
  for (int i = 1; i < count; ++i) {
    group_of[i] = groups.find(i);
    Piece& extent = extents[group_of[i]];
    extent.box = extent.area_px == 0 ? pieces[i].box : extent.box | pieces[i].box;
    extent.area_px += pieces[i].area_px;
  }
  std::vector<int> order;
  for (int i = 1; i < count; ++i) {
    if (extents[i].area_px >= parameters.min_area_px) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return extents[a].area_px > extents[b].area_px; });
  for (const int group : order) {
    if (static_cast<int>(plants.stem_px.size()) >= parameters.max_plants) break;
    split_group(labels, group_of, group, extents[group], parameters, plants);
  }
  return plants;
}

}  // namespace furrow::vision
