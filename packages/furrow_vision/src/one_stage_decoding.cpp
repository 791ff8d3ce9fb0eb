#include "furrow_vision/one_stage_decoding.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <string>

#include "furrow_core/point_grid.hpp"
#include "furrow_core/statistics.hpp"

namespace furrow::vision {
namespace {

double sigmoid(double logit) {
  return 1.0 / (1.0 + std::exp(-logit));
}

Eigen::Vector2d centre_of(int column, int row, const CellGrid& grid) {
  return (Eigen::Vector2d(column, row).array() + 0.5) * grid.stride_px - 0.5;
}

Eigen::Vector2d offset_at(const OneStageMaps& maps, int row, int column, const CellGrid& grid) {
  return grid.offset_unit_px * Eigen::Vector2d(maps.offset_u.at<float>(row, column),
                                               maps.offset_v.at<float>(row, column));
}

std::vector<Eigen::Vector2d> places_of(const std::vector<StemPeak>& stems) {
  std::vector<Eigen::Vector2d> places;
  for (const StemPeak& stem : stems) places.push_back(stem.stem_px);
  return places;
}

/// Each coordinate on its own.
Eigen::Vector2d median_point(std::vector<Eigen::Vector2d> points) {
  Eigen::Vector2d result;
  for (int axis = 0; axis < 2; ++axis) {
    result[axis] = median_element(std::span(points), [axis](const auto& a, const auto& b) {
      return a[axis] < b[axis];
    })[axis];
  }
  return result;
}

/// The most frequent plant next to a group of cells; 0: none.
int touching_label(const cv::Mat& labels, const std::vector<cv::Point>& cells) {
  std::map<int, int> counts;
  for (const cv::Point& cell : cells) {
    for (int v = std::max(cell.y - 1, 0); v <= std::min(cell.y + 1, labels.rows - 1); ++v) {
      for (int u = std::max(cell.x - 1, 0); u <= std::min(cell.x + 1, labels.cols - 1); ++u) {
        const int label = labels.at<int>(v, u);
        if (label > 0) ++counts[label];
      }
    }
  }
  int best = 0, most = 0;
  for (const auto& [label, count] : counts) {
    if (count > most) {
      best = label;
      most = count;
    }
  }
  return best;
}

bool touches(const cv::Mat& labels, const std::vector<cv::Point>& cells, int label) {
  return std::any_of(cells.begin(), cells.end(), [&](const cv::Point& cell) {
    const cv::Rect around =
        cv::Rect(cell.x - 1, cell.y - 1, 3, 3) & cv::Rect(cv::Point(), labels.size());
    return cv::countNonZero(labels(around) == label) > 0;
  });
}

class Decoder {
 public:
  Decoder(const OneStageMaps& maps, const cv::Mat& vegetation, const CellGrid& grid,
          const OneStageDecodingParameters& parameters)
      : maps_(maps),
        vegetation_(vegetation),
        grid_(grid),
        parameters_(parameters),
        base_reach_px_(parameters.vote_radius_mm / grid.mm_per_px),
        most_reach_px_(base_reach_px_ + parameters.vote_radius_factor * 4.0 * grid.offset_unit_px),
        stems_(find_stems(maps, grid, parameters)),
        labels_(cv::Mat::zeros(vegetation.size(), CV_32S)) {}

  DecodedPlants decode() {
    take_votes();
    place_stems_without_votes();
    group_leftovers();
    return describe();
  }

 private:
  [[nodiscard]] double reach_px(const Eigen::Vector2d& offset_px) const {
    return std::min(base_reach_px_ + parameters_.vote_radius_factor * offset_px.norm(),
                    most_reach_px_);
  }

  void take_votes() {
    const auto places = places_of(stems_);
    const PointGrid<Eigen::Vector2d> stems(places, most_reach_px_);
    votes_.assign(stems_.size(), 0);
    leftover_ = cv::Mat::zeros(vegetation_.size(), CV_8U);
    for (int v = 0; v < vegetation_.rows; ++v) {
      const auto* set = vegetation_.ptr<std::uint8_t>(v);
      for (int u = 0; u < vegetation_.cols; ++u) {
        if (set[u] == 0) continue;
        const Eigen::Vector2d offset = offset_at(maps_, v, u, grid_);
        const auto stem = stems.nearest(centre_of(u, v, grid_) + offset, reach_px(offset));
        if (stem) {
          labels_.at<int>(v, u) = static_cast<int>(*stem) + 1;
          ++votes_[*stem];
        } else {
          leftover_.at<std::uint8_t>(v, u) = 255;
        }
      }
    }
  }

  /// Of a weed below the leaves of a crop the network may know where it stands and take what shows
  /// of it for the crop's.
  void place_stems_without_votes() {
    for (std::size_t i = 0; i < stems_.size(); ++i) {
      if (votes_[i] > 0) continue;
      const cv::Point cell = cell_at(stems_[i].stem_px);
      if (vegetation_.at<std::uint8_t>(cell) == 0) continue;
      labels_.at<int>(cell) = static_cast<int>(i) + 1;
      leftover_.at<std::uint8_t>(cell) = 0;
    }
  }

  void group_leftovers() {
    cv::Mat groups;
    const int count = cv::connectedComponents(leftover_, groups, 8, CV_32S);
    std::vector<std::vector<cv::Point>> cells(static_cast<std::size_t>(count));
    for (int v = 0; v < groups.rows; ++v) {
      const int* group = groups.ptr<int>(v);
      for (int u = 0; u < groups.cols; ++u) {
        if (group[u] > 0) cells[group[u]].emplace_back(u, v);
      }
    }
    const auto places = places_of(stems_);
    const PointGrid<Eigen::Vector2d> stems(places, 3.0 * most_reach_px_);
    const double cell_mm2 = std::pow(grid_.stride_px * grid_.mm_per_px, 2);
    const cv::Mat voted = labels_.clone();  // so that the order of groups does not matter
    for (const auto& group : cells) {
      if (group.empty()) continue;
      std::vector<Eigen::Vector2d> votes;
      votes.reserve(group.size());
      double mean_reach_px = 0.0;
      for (const cv::Point& cell : group) {
        const Eigen::Vector2d offset = offset_at(maps_, cell.y, cell.x, grid_);
        mean_reach_px += reach_px(offset) / static_cast<double>(group.size());
        votes.push_back(centre_of(cell.x, cell.y, grid_) + offset);
      }
      const Eigen::Vector2d vote = median_point(std::move(votes));
      const auto stem = stems.nearest(vote, 3.0 * mean_reach_px);
      int label = stem ? static_cast<int>(*stem) + 1 : 0;
      if (label == 0 || !touches(voted, group, label)) {
        const bool large =
            static_cast<double>(group.size()) * cell_mm2 >= parameters_.min_plant_area_mm2;
        if (large && static_cast<int>(stems_.size() + own_.size()) < 2 * kMaxStems) {
          own_.push_back({vote, probability_at(vote)});
          label = static_cast<int>(stems_.size() + own_.size());
        } else {
          label = touching_label(voted, group);
        }
      }
      for (const cv::Point& cell : group) labels_.at<int>(cell) = label;
    }
  }

  /// The nearest one: the point may lie outside.
  [[nodiscard]] cv::Point cell_at(const Eigen::Vector2d& p_px) const {
    const Eigen::Vector2d cell = (p_px.array() + 0.5) / grid_.stride_px - 0.5;
    const double u = std::clamp(cell.x(), 0.0, maps_.stem_logit.cols - 1.0);
    const double v = std::clamp(cell.y(), 0.0, maps_.stem_logit.rows - 1.0);
    return {static_cast<int>(std::lround(u)), static_cast<int>(std::lround(v))};
  }

  [[nodiscard]] double probability_at(const Eigen::Vector2d& stem_px) const {
    return sigmoid(maps_.stem_logit.at<float>(cell_at(stem_px)));
  }

  DecodedPlants describe() {
    const std::size_t classes = maps_.class_logits.size();
    const std::size_t most = stems_.size() + own_.size();
    struct Sum {
      int cells = 0;
      double plant = 0.0;
      double evidence = 0.0;
    };
    const cv::Mat evidence = plant_evidence(maps_, parameters_);
    std::vector<Sum> sums(most);
    std::vector<double> logits(most * classes, 0.0);
    for (int v = 0; v < labels_.rows; ++v) {
      const int* label = labels_.ptr<int>(v);
      for (int u = 0; u < labels_.cols; ++u) {
        if (label[u] == 0) continue;
        const auto i = static_cast<std::size_t>(label[u] - 1);
        const double plant = sigmoid(maps_.plant_logit.at<float>(v, u));
        ++sums[i].cells;
        sums[i].plant += plant;
        sums[i].evidence += sigmoid(evidence.at<float>(v, u));
        for (std::size_t k = 0; k < classes; ++k) {
          logits[i * classes + k] += plant * maps_.class_logits[k].at<float>(v, u);
        }
      }
    }
    DecodedPlants decoded;
    std::vector<int> renamed(most + 1, 0);
    for (std::size_t i = 0; i < most; ++i) {
      if (sums[i].cells == 0) continue;
      const StemPeak& stem = i < stems_.size() ? stems_[i] : own_[i - stems_.size()];
      DecodedPlant plant{.stem_px = stem.stem_px,
                         .stem_probability = stem.probability,
                         .plant_probability = sums[i].evidence / sums[i].cells,
                         .class_scores = {},
                         .cells = sums[i].cells};
      const double weight = std::max(sums[i].plant, 1e-12);
      const auto first = logits.begin() + static_cast<std::ptrdiff_t>(i * classes);
      const double highest = *std::max_element(first, first + static_cast<std::ptrdiff_t>(classes));
      double total = 0.0;
      for (std::size_t k = 0; k < classes; ++k) {
        plant.class_scores.push_back(
            std::exp((first[static_cast<std::ptrdiff_t>(k)] - highest) / weight));
        total += plant.class_scores.back();
      }
      for (double& score : plant.class_scores) score /= total;
      decoded.plants.push_back(std::move(plant));
      renamed[i + 1] = static_cast<int>(decoded.plants.size());
    }
    for (int v = 0; v < labels_.rows; ++v) {
      int* label = labels_.ptr<int>(v);
      for (int u = 0; u < labels_.cols; ++u) label[u] = renamed[label[u]];
    }
    decoded.labels = labels_;
    return decoded;
  }

  const OneStageMaps& maps_;
  const cv::Mat& vegetation_;
  const CellGrid& grid_;
  const OneStageDecodingParameters& parameters_;
  double base_reach_px_;
  double most_reach_px_;
  std::vector<StemPeak> stems_;
  std::vector<int> votes_;     ///< for stems_
  std::vector<StemPeak> own_;  ///< of plants that no peak belongs to
  cv::Mat labels_;
  cv::Mat leftover_;
};

}  // namespace

void OneStageDecodingParameters::visit(ParameterVisitor& v) {
  v.visit({.name = "stem_threshold",
           .description = "Probability of a stem from which on a peak counts",
           .min = 0.01,
           .max = 0.99},
          stem_threshold);
  v.visit({.name = "stem_separation_mm",
           .unit = "mm",
           .description = "Of two stems nearer than this the weaker is dropped",
           .min = 0.0,
           .max = 500.0},
          stem_separation_mm);
  v.visit({.name = "stem_evidence",
           .description = "Log-odds that a stem speaks more for a plant than for itself",
           .min = -100.0,
           .max = 100.0},
          stem_evidence);
  v.visit({.name = "vote_radius_mm",
           .unit = "mm",
           .description = "How far from a stem a cell may point to be its plant's",
           .min = 0.1,
           .max = 500.0},
          vote_radius_mm);
  v.visit({.name = "vote_radius_factor",
           .description = "Added to that radius, as a share of how far the cell is from the stem",
           .min = 0.0,
           .max = 1.0},
          vote_radius_factor);
  v.visit({.name = "min_plant_area_mm2",
           .unit = "mm2",
           .description = "Smaller ones are taken for specks",
           .min = 0.0,
           .max = 1e5},
          min_plant_area_mm2);
}

Result<OneStageMaps> split_one_stage_output(const cv::Mat& output, std::size_t classes) {
  const bool fits = output.dims == 4 && output.type() == CV_32F && output.size[0] == 1 &&
                    output.size[1] == static_cast<int>(4 + classes) && output.size[2] > 0 &&
                    output.size[3] > 0 && output.isContinuous() && classes > 0;
  if (!fits) {
    std::string shape;
    for (int i = 0; i < output.dims; ++i) shape += (i ? "x" : "") + std::to_string(output.size[i]);
    return Error{ErrorCode::kInvalidArgument,
                 "the network's output is " + shape + ", not 1x" + std::to_string(4 + classes) +
                     " maps: it is of other classes, or no one-stage network"};
  }
  const auto map = [&](int channel) {
    return cv::Mat(output.size[2], output.size[3], CV_32F,
                   const_cast<float*>(output.ptr<float>(0, channel)));
  };
  OneStageMaps maps{map(0), map(1), map(2), map(3), {}};
  for (std::size_t i = 0; i < classes; ++i) {
    maps.class_logits.push_back(map(static_cast<int>(4 + i)));
  }
  // A sum is finite when every value is, unless they are huge, which is as wrong.
  const float* value = output.ptr<float>();
  double sum = 0.0;
  for (std::size_t i = 0; i < output.total(); ++i) sum += value[i];
  if (!std::isfinite(sum)) {
    return Error{ErrorCode::kInvalidArgument, "the network's output is not finite"};
  }
  return maps;
}

std::vector<StemPeak> find_stems(const OneStageMaps& maps, const CellGrid& grid,
                                 const OneStageDecodingParameters& parameters) {
  const cv::Mat& logit = maps.stem_logit;
  const auto threshold =
      static_cast<float>(std::log(parameters.stem_threshold / (1.0 - parameters.stem_threshold)));
  cv::Mat highest;
  cv::dilate(logit, highest, cv::Mat::ones(3, 3, CV_8U), cv::Point(-1, -1), 1,
             cv::BORDER_REPLICATE);
  std::vector<StemPeak> peaks;
  for (int v = 0; v < logit.rows; ++v) {
    const float* value = logit.ptr<float>(v);
    const float* most = highest.ptr<float>(v);
    for (int u = 0; u < logit.cols; ++u) {
      if (value[u] < most[u] || value[u] < threshold) continue;
      Eigen::Vector2d sum = Eigen::Vector2d::Zero();
      double weight = 0.0;
      for (int b = std::max(v - 1, 0); b <= std::min(v + 1, logit.rows - 1); ++b) {
        for (int a = std::max(u - 1, 0); a <= std::min(u + 1, logit.cols - 1); ++a) {
          // Cells of soil were never taught an offset.
          const double w =
              sigmoid(logit.at<float>(b, a)) * sigmoid(maps.plant_logit.at<float>(b, a));
          sum += w * (centre_of(a, b, grid) + offset_at(maps, b, a, grid));
          weight += w;
        }
      }
      const Eigen::Vector2d centre = centre_of(u, v, grid);
      Eigen::Vector2d stem = weight > 1e-6 ? Eigen::Vector2d(sum / weight) : centre;
      // Offsets that lead away from the peak contradict it: the peak stands.
      if ((stem - centre).norm() > 2.0 * grid.stride_px) stem = centre;
      peaks.push_back({stem, sigmoid(value[u])});
    }
  }
  std::stable_sort(peaks.begin(), peaks.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
  const double separation_px = parameters.stem_separation_mm / grid.mm_per_px;
  std::vector<StemPeak> kept;
  for (const StemPeak& peak : peaks) {
    if (static_cast<int>(kept.size()) >= kMaxStems) break;
    const bool alone = std::none_of(kept.begin(), kept.end(), [&](const StemPeak& other) {
      return (other.stem_px - peak.stem_px).squaredNorm() < separation_px * separation_px;
    });
    if (alone) kept.push_back(peak);
  }
  return kept;
}

cv::Mat plant_evidence(const OneStageMaps& maps, const OneStageDecodingParameters& parameters) {
  cv::Mat evidence;
  cv::max(maps.plant_logit, maps.stem_logit + parameters.stem_evidence, evidence);
  return evidence;
}

DecodedPlants decode_one_stage(const OneStageMaps& maps, const cv::Mat& vegetation,
                               const CellGrid& grid, const OneStageDecodingParameters& parameters) {
  return Decoder(maps, vegetation, grid, parameters).decode();
}

}  // namespace furrow::vision
