#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "furrow_simulation/ground.hpp"

namespace furrow::simulation {

/// The blocks of ground under the camera, in a ring in both directions: texel (x, y) of F stands
/// at (x mod rows, y mod columns). Bounded: at most kMaxBlocks blocks a side.
class GroundAtlas {
 public:
  static constexpr int kMaxBlocks = 16;

  /// Inclusive bounds in texels of F.
  struct Window {
    std::int32_t first_x = 0;
    std::int32_t first_y = 0;
    std::int32_t last_x = -1;
    std::int32_t last_y = -1;
  };
  using Casters = std::function<void(std::int32_t block_x, std::int32_t block_y,
                                     std::vector<ShadowTriangle>& casters)>;

  explicit GroundAtlas(const Ground& ground) : ground_(ground) {}

  /// Makes the blocks that the window touches and that are not there. `casters` is called on this
  /// thread, before blocks are made on `threads` threads.
  /// @pre the window spans at most kMaxBlocks blocks a side.
  void prepare(const Window& window, const Casters& casters, int threads);

  /// Reads texels of the window. Valid until the next call of prepare.
  class Reader {
   public:
    [[nodiscard]] const GroundTexel& texel(std::int32_t x, std::int32_t y) const {
      return row(x)[y & column_mask_];
    }
    /// The row of texels at x, from which texel y is read at column(y).
    [[nodiscard]] const GroundTexel* row(std::int32_t x) const {
      return texels_ + (static_cast<std::ptrdiff_t>(x & row_mask_) << row_shift_);
    }
    [[nodiscard]] std::ptrdiff_t column(std::int32_t y) const { return y & column_mask_; }

   private:
    friend class GroundAtlas;
    const GroundTexel* texels_ = nullptr;
    int row_shift_ = 0;
    std::int32_t row_mask_ = 0;
    std::int32_t column_mask_ = 0;
  };
  [[nodiscard]] Reader reader() const;

 private:
  struct Slot {
    bool filled = false;
    std::int32_t block_x = 0;
    std::int32_t block_y = 0;
  };

  const Ground& ground_;
  int blocks_x_ = 0;  // powers of two
  int blocks_y_ = 0;
  std::int32_t row_mask_ = 0;
  std::int32_t column_mask_ = 0;
  std::size_t stride_ = 0;
  std::vector<GroundTexel> texels_;
  std::vector<Slot> slots_;
};

}  // namespace furrow::simulation
