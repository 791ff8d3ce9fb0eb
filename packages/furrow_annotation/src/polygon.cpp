#include "furrow_annotation/polygon.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace furrow::annotation {
namespace {

/// Grid points per pixel on which edges are stepped through.
constexpr int kFine = 5;

struct FinePoint {
  int u = 0;
  int v = 0;
};

FinePoint to_fine(const Eigen::Vector2d& corner) {
  return {static_cast<int>(kFine * corner.x() + 0.5), static_cast<int>(kFine * corner.y() + 0.5)};
}

/// Where the outline crosses the middle line of a column: pixels from `row` on change sides.
class Crossings {
 public:
  explicit Crossings(cv::Size size) : size_(size) {}

  /// Takes two neighbours of the stepped outline that lie in different fine columns.
  void add(const FinePoint& a, const FinePoint& b) {
    // The middle of pixel column c lies between the fine columns 5c + 2 and 5c + 3.
    const int left = std::min(a.u, b.u);
    if (left < 0 || left % kFine != kFine / 2) return;
    const int column = left / kFine;
    if (column >= size_.width) return;
    const double v = (std::min(a.v, b.v) + 0.5) / kFine - 0.5;
    const int row = static_cast<int>(std::ceil(std::clamp<double>(v, 0.0, size_.height)));
    at_.push_back(static_cast<std::uint32_t>(column) * static_cast<std::uint32_t>(size_.height) +
                  static_cast<std::uint32_t>(row));
  }

  [[nodiscard]] RunLengths runs() {
    std::sort(at_.begin(), at_.end());
    at_.push_back(static_cast<std::uint32_t>(size_.area()));
    RunLengths runs;
    std::uint32_t last = 0;
    bool extends = false;  // two crossings at one place: the previous run continues
    for (const std::uint32_t crossing : at_) {
      const std::uint32_t length = crossing - last;
      last = crossing;
      if (length == 0 && !runs.empty()) {
        extends = !extends;
      } else if (extends) {
        runs.back() += length;
        extends = false;
      } else {
        runs.push_back(length);
      }
    }
    return runs;
  }

 private:
  cv::Size size_;
  std::vector<std::uint32_t> at_;
};

/// Steps through an edge one fine grid point at a time along its longer axis. Rounding is the same
/// from either end.
void step_edge(FinePoint from, FinePoint to, Crossings& crossings) {
  const int du = std::abs(to.u - from.u), dv = std::abs(to.v - from.v);
  const bool along_u = du >= dv;
  const bool swapped = along_u ? from.u > to.u : from.v > to.v;
  if (swapped) std::swap(from, to);
  const int steps = std::max(du, dv);
  if (steps == 0) return;
  const double slope =
      along_u ? static_cast<double>(to.v - from.v) / du : static_cast<double>(to.u - from.u) / dv;
  FinePoint last = from;
  for (int step = 1; step <= steps; ++step) {
    const FinePoint next =
        along_u ? FinePoint{from.u + step, static_cast<int>(from.v + slope * step + 0.5)}
                : FinePoint{static_cast<int>(from.u + slope * step + 0.5), from.v + step};
    if (next.u != last.u) crossings.add(last, next);
    last = next;
  }
}

}  // namespace

RunLengths polygon_run_lengths(const CornerPolygon& polygon, cv::Size size) {
  Crossings crossings(size);
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    step_edge(to_fine(polygon[i]), to_fine(polygon[(i + 1) % polygon.size()]), crossings);
  }
  return crossings.runs();
}

RunLengths unite(const std::vector<RunLengths>& masks) {
  if (masks.empty()) return {};
  RunLengths united = masks.front();
  for (std::size_t i = 1; i < masks.size(); ++i) {
    const std::array<const RunLengths*, 2> sources = {&united, &masks[i]};
    std::array<std::size_t, 2> index = {0, 0};
    std::array<std::uint32_t, 2> left = {united.empty() ? 0 : united[0],
                                         masks[i].empty() ? 0 : masks[i][0]};
    RunLengths next;
    bool set = false;
    std::uint32_t length = 0;
    while (index[0] < sources[0]->size() && index[1] < sources[1]->size()) {
      const bool now = index[0] % 2 == 1 || index[1] % 2 == 1;
      const std::uint32_t step = std::min(left[0], left[1]);
      if (now != set && step > 0) {
        next.push_back(length);
        length = 0;
        set = now;
      }
      length += step;
      for (std::size_t k = 0; k < 2; ++k) {
        left[k] -= step;
        if (left[k] == 0 && ++index[k] < sources[k]->size()) left[k] = (*sources[k])[index[k]];
      }
    }
    next.push_back(length);
    united = std::move(next);
  }
  return united;
}

}  // namespace furrow::annotation
