#include "furrow_vision/region_proposals.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace furrow::vision {
namespace {

struct Candidate {
  RegionBox box;
  float score = 0.0f;
};

/// The best candidates of one level after suppression.
std::vector<Candidate> propose_on_level(const cv::Mat& objectness, const cv::Mat& deltas,
                                        double stride_px, const std::vector<RegionBox>& anchors,
                                        cv::Size input, const ProposalLimits& limits) {
  const int rows = objectness.size[2], columns = objectness.size[3];
  const std::size_t plane = static_cast<std::size_t>(rows) * columns;
  const float* score = objectness.ptr<float>();
  std::vector<std::size_t> order(objectness.total());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t count = std::min(limits.before_suppression, order.size());
  // By place where scores agree, so that the order is one.
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return score[a] != score[b] ? score[a] > score[b] : a < b;
                    });
  std::vector<RegionBox> boxes;
  std::vector<float> scores;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t anchor = order[i] / plane, cell = order[i] % plane;
    const auto u = static_cast<float>(static_cast<double>(cell % columns) * stride_px);
    const auto v = static_cast<float>(static_cast<double>(cell / columns) * stride_px);
    RegionBox box = anchors[anchor];
    box = {box.u0 + u, box.v0 + v, box.u1 + u, box.v1 + v};
    std::array<float, 4> delta{};
    for (std::size_t k = 0; k < 4; ++k) {
      delta[k] = deltas.ptr<float>()[(4 * anchor + k) * plane + cell];
    }
    box = clip_box(decode_box(box, delta, {1.0f, 1.0f, 1.0f, 1.0f}), input);
    constexpr float kLeast_px = 1e-3f;
    if (!(box.width() >= kLeast_px && box.height() >= kLeast_px)) continue;
    boxes.push_back(box);
    scores.push_back(score[order[i]]);
  }
  std::vector<Candidate> kept;
  for (const int i : suppress_overlaps(boxes, scores, limits.iou_max, limits.after_suppression)) {
    kept.push_back({boxes[i], scores[i]});
  }
  return kept;
}

float bilinear(const float* plane, int rows, int columns, float v, float u) {
  if (v < -1.0f || v > static_cast<float>(rows) || u < -1.0f || u > static_cast<float>(columns)) {
    return 0.0f;
  }
  v = std::clamp(v, 0.0f, static_cast<float>(rows - 1));
  u = std::clamp(u, 0.0f, static_cast<float>(columns - 1));
  const int v0 = static_cast<int>(v), u0 = static_cast<int>(u);
  const int v1 = std::min(v0 + 1, rows - 1), u1 = std::min(u0 + 1, columns - 1);
  const float b = v - static_cast<float>(v0), a = u - static_cast<float>(u0);
  const float* upper = plane + static_cast<std::ptrdiff_t>(v0) * columns;
  const float* lower = plane + static_cast<std::ptrdiff_t>(v1) * columns;
  return (1.0f - b) * ((1.0f - a) * upper[u0] + a * upper[u1]) +
         b * ((1.0f - a) * lower[u0] + a * lower[u1]);
}

/// A place between two neighbouring cells of a line.
struct Sample {
  int low = 0, high = 0;
  float low_weight = 0.0f, high_weight = 0.0f;
};

/// `count` places in the middle of equal parts of a length; beyond a cell outside the map they
/// weigh nothing.
std::vector<Sample> samples_along(float start, float length, int count, int cells) {
  std::vector<Sample> samples(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    float at = start + (static_cast<float>(i) + 0.5f) * length / static_cast<float>(count);
    if (!(at >= -1.0f && at <= static_cast<float>(cells))) continue;
    at = std::clamp(at, 0.0f, static_cast<float>(cells - 1));
    Sample& sample = samples[static_cast<std::size_t>(i)];
    sample.low = static_cast<int>(at);
    sample.high = std::min(sample.low + 1, cells - 1);
    sample.high_weight = at - static_cast<float>(sample.low);
    sample.low_weight = 1.0f - sample.high_weight;
  }
  return samples;
}

}  // namespace

double region_iou(const RegionBox& a, const RegionBox& b) {
  const double width = std::min(a.u1, b.u1) - std::max(a.u0, b.u0);
  const double height = std::min(a.v1, b.v1) - std::max(a.v0, b.v0);
  const double both = width > 0.0 && height > 0.0 ? width * height : 0.0;
  const double united = static_cast<double>(a.width()) * a.height() +
                        static_cast<double>(b.width()) * b.height() - both;
  return united > 0.0 ? both / united : 0.0;
}

std::vector<RegionBox> base_anchors(double size_px, const std::vector<double>& aspect_ratios) {
  std::vector<RegionBox> anchors;
  for (const double ratio : aspect_ratios) {
    // nearbyint rounds halves to even, as torch does.
    const auto u = static_cast<float>(std::nearbyint(0.5 * size_px / std::sqrt(ratio)));
    const auto v = static_cast<float>(std::nearbyint(0.5 * size_px * std::sqrt(ratio)));
    anchors.push_back({-u, -v, u, v});
  }
  return anchors;
}

RegionBox decode_box(const RegionBox& anchor, const std::array<float, 4>& deltas,
                     const std::array<float, 4>& weights) {
  const float most = std::log(1000.0f / 16.0f);
  const float u = anchor.u0 + 0.5f * anchor.width() + deltas[0] / weights[0] * anchor.width();
  const float v = anchor.v0 + 0.5f * anchor.height() + deltas[1] / weights[1] * anchor.height();
  const float width = anchor.width() * std::exp(std::min(deltas[2] / weights[2], most));
  const float height = anchor.height() * std::exp(std::min(deltas[3] / weights[3], most));
  return {u - 0.5f * width, v - 0.5f * height, u + 0.5f * width, v + 0.5f * height};
}

RegionBox clip_box(const RegionBox& box, cv::Size image) {
  const auto width = static_cast<float>(image.width), height = static_cast<float>(image.height);
  return {std::clamp(box.u0, 0.0f, width), std::clamp(box.v0, 0.0f, height),
          std::clamp(box.u1, 0.0f, width), std::clamp(box.v1, 0.0f, height)};
}

std::vector<int> suppress_overlaps(const std::vector<RegionBox>& boxes,
                                   const std::vector<float>& scores, double iou_max,
                                   std::size_t most) {
  std::vector<int> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return scores[a] > scores[b]; });
  std::vector<int> kept;
  for (const int i : order) {
    if (kept.size() >= most) break;
    const bool free = std::none_of(kept.begin(), kept.end(),
                                   [&](int k) { return region_iou(boxes[i], boxes[k]) > iou_max; });
    if (free) kept.push_back(i);
  }
  return kept;
}

Result<std::vector<RegionBox>> propose_regions(const std::vector<cv::Mat>& objectness,
                                               const std::vector<cv::Mat>& deltas,
                                               const AnchorLayout& anchors, cv::Size input,
                                               const ProposalLimits& limits) {
  const std::size_t levels = anchors.sizes_px.size();
  const int ratios = static_cast<int>(anchors.aspect_ratios.size());
  const auto fits = [&](const cv::Mat& map, int channels, const cv::Mat& like) {
    return map.dims == 4 && map.type() == CV_32F && map.isContinuous() && map.size[0] == 1 &&
           map.size[1] == channels && map.size[2] == like.size[2] && map.size[3] == like.size[3];
  };
  bool good = objectness.size() == levels && deltas.size() == levels;
  for (std::size_t i = 0; good && i < levels; ++i) {
    good = objectness[i].dims == 4 && fits(objectness[i], ratios, objectness[i]) &&
           fits(deltas[i], 4 * ratios, objectness[i]);
  }
  if (!good) {
    return Error{ErrorCode::kInvalidArgument, "the proposals do not fit the model file's anchors"};
  }
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < levels; ++i) {
    const auto level =
        propose_on_level(objectness[i], deltas[i], anchors.strides_px[i],
                         base_anchors(anchors.sizes_px[i], anchors.aspect_ratios), input, limits);
    all.insert(all.end(), level.begin(), level.end());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.score > b.score; });
  all.resize(std::min(all.size(), limits.after_suppression));
  std::vector<RegionBox> boxes;
  boxes.reserve(all.size());
  for (const Candidate& candidate : all) boxes.push_back(candidate.box);
  return boxes;
}

int pyramid_level(const RegionBox& box, int levels) {
  constexpr double kCanonical_px = 224.0, kCanonicalLevel = 4.0, kFirstLevel = 2.0;
  const double size = std::sqrt(std::max(0.0, static_cast<double>(box.width()) * box.height()));
  if (!(size > 0.0)) return 0;
  const double level =
      std::floor(kCanonicalLevel + std::log2(size / kCanonical_px) + 1e-6) - kFirstLevel;
  return static_cast<int>(std::clamp(level, 0.0, levels - 1.0));
}

void align_region(const cv::Mat& features, const RegionBox& box, double stride_px, int size,
                  float* out) {
  constexpr int kSamples = 2;
  const auto scale = static_cast<float>(1.0 / stride_px);
  const int channels = features.size[1], rows = features.size[2], columns = features.size[3];
  // The places of the samples are those of every channel.
  const std::vector<Sample> along_u =
      samples_along(box.u0 * scale, std::max(box.width() * scale, 1.0f), kSamples * size, columns);
  const std::vector<Sample> along_v =
      samples_along(box.v0 * scale, std::max(box.height() * scale, 1.0f), kSamples * size, rows);
  std::vector<float> lines(along_u.size());
  for (int c = 0; c < channels; ++c) {
    const float* plane = features.ptr<float>(0, c);
    for (int b = 0; b < size; ++b) {
      std::fill(lines.begin(), lines.end(), 0.0f);
      for (int y = kSamples * b; y < kSamples * (b + 1); ++y) {
        const float* low = plane + static_cast<std::ptrdiff_t>(along_v[y].low) * columns;
        const float* high = plane + static_cast<std::ptrdiff_t>(along_v[y].high) * columns;
        for (std::size_t x = 0; x < along_u.size(); ++x) {
          const Sample& u = along_u[x];
          lines[x] +=
              along_v[y].low_weight * (u.low_weight * low[u.low] + u.high_weight * low[u.high]) +
              along_v[y].high_weight * (u.low_weight * high[u.low] + u.high_weight * high[u.high]);
        }
      }
      for (int a = 0; a < size; ++a) {
        float sum = 0.0f;
        for (int x = kSamples * a; x < kSamples * (a + 1); ++x) sum += lines[x];
        *out++ = sum / (kSamples * kSamples);
      }
    }
  }
}

cv::Mat stretch_mask(const cv::Mat& logits, const RegionBox& box, const cv::Rect& pixels) {
  cv::Mat result(pixels.size(), CV_32F);
  const float per_u = static_cast<float>(logits.cols) / std::max(box.width(), 1e-3f);
  const float per_v = static_cast<float>(logits.rows) / std::max(box.height(), 1e-3f);
  for (int v = 0; v < pixels.height; ++v) {
    const float row = std::clamp((static_cast<float>(pixels.y + v) + 0.5f - box.v0) * per_v - 0.5f,
                                 0.0f, static_cast<float>(logits.rows - 1));
    for (int u = 0; u < pixels.width; ++u) {
      const float column =
          std::clamp((static_cast<float>(pixels.x + u) + 0.5f - box.u0) * per_u - 0.5f, 0.0f,
                     static_cast<float>(logits.cols - 1));
      result.at<float>(v, u) = bilinear(logits.ptr<float>(), logits.rows, logits.cols, row, column);
    }
  }
  return result;
}

}  // namespace furrow::vision
