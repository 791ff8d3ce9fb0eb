#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace furrow::tracking {

/// A plant's silhouette on the ground: cells of a grid fixed in the field frame F, stored as runs
/// along x. Cell (row, column) covers x in [column, column + 1) * cell_m and y in
/// [row, row + 1) * cell_m. Masks of the same cell size share the grid, so they are compared
/// without resampling. Sizes in metres and mm2.
class GroundMask {
 public:
  struct Run {
    std::int32_t row = 0;
    std::int32_t begin = 0;  ///< first column
    std::int32_t end = 0;    ///< one past the last column
    bool operator==(const Run&) const = default;
  };

  GroundMask() = default;
  /// The cells that hold at least one of the points; points that are not finite or farther than
  /// 1e6 cells from F's origin are left out. @pre cell_m > 0 and finite.
  [[nodiscard]] static GroundMask from_points(std::span<const Eigen::Vector2d> points_F,
                                              double cell_m);
  /// The cells whose centres lie within a circle. @pre cell_m > 0; radius_m in [0, 1e4 * cell_m].
  [[nodiscard]] static GroundMask from_circle(const Eigen::Vector2d& centre_F, double radius_m,
                                              double cell_m);

  [[nodiscard]] bool empty() const { return runs_.empty(); }
  [[nodiscard]] double cell_m() const { return cell_m_; }
  /// In the order of row, then column; neither overlapping nor touching.
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
  [[nodiscard]] std::int64_t cell_count() const;
  [[nodiscard]] double area_mm2() const;
  /// Mean of the cells' centres, in F; nothing when empty.
  [[nodiscard]] std::optional<Eigen::Vector2d> centroid() const;

  /// Cells in both over cells in either (Jaccard); 0 when either is empty or the cell sizes differ.
  [[nodiscard]] static double iou(const GroundMask& a, const GroundMask& b);

 private:
  double cell_m_ = 0.0;
  std::vector<Run> runs_;
};

}  // namespace furrow::tracking
