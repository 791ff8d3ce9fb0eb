#include "instance_cutting.hpp"

#include <algorithm>

namespace furrow::vision {
namespace {

/// The label of a cell, or of a neighbouring one where the cell holds too little vegetation to have
/// one itself.
int label_at(const cv::Mat& labels, int v, int u) {
  const int own = labels.at<int>(v, u);
  if (own != 0) return own;
  for (int b = std::max(v - 1, 0); b <= std::min(v + 1, labels.rows - 1); ++b) {
    for (int a = std::max(u - 1, 0); a <= std::min(u + 1, labels.cols - 1); ++a) {
      if (labels.at<int>(b, a) != 0) return labels.at<int>(b, a);
    }
  }
  return 0;
}

std::vector<int> cells_of(int pixels, double cells_per_px, int cells) {
  std::vector<int> result(static_cast<std::size_t>(pixels));
  for (int i = 0; i < pixels; ++i) {
    result[i] = std::clamp(static_cast<int>(i * cells_per_px + 1e-9), 0, cells - 1);
  }
  return result;
}

}  // namespace

std::vector<Instance> cut_instances(const cv::Mat& mask, const cv::Mat& labels,
                                    const cv::Point2d& cells_per_px, std::size_t count) {
  std::vector<Instance> instances(count);
  std::vector<cv::Point> low(count, {mask.cols, mask.rows}), high(count);
  cv::Mat full = cv::Mat::zeros(mask.size(), CV_32S);
  const std::vector<int> cell_u = cells_of(mask.cols, cells_per_px.x, labels.cols);
  const std::vector<int> cell_v = cells_of(mask.rows, cells_per_px.y, labels.rows);
  for (int v = 0; v < mask.rows; ++v) {
    const auto* set = mask.ptr<std::uint8_t>(v);
    int* out = full.ptr<int>(v);
    for (int u = 0; u < mask.cols; ++u) {
      if (set[u] == 0) continue;
      const int label = label_at(labels, cell_v[v], cell_u[u]);
      if (label == 0) continue;
      out[u] = label;
      low[label - 1] = {std::min(low[label - 1].x, u), std::min(low[label - 1].y, v)};
      high[label - 1] = {std::max(high[label - 1].x, u + 1), std::max(high[label - 1].y, v + 1)};
    }
  }
  for (std::size_t i = 0; i < instances.size(); ++i) {
    if (high[i].x == 0) continue;
    instances[i].box_px = cv::Rect(low[i], high[i]);
    instances[i].mask = full(instances[i].box_px) == static_cast<int>(i) + 1;
  }
  return instances;
}

}  // namespace furrow::vision
