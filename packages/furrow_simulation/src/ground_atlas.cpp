#include "ground_atlas.hpp"

#include <algorithm>
#include <bit>

#include "furrow_core/parallel.hpp"

namespace furrow::simulation {
namespace {

constexpr int kSize = GroundBlock::kSize;
static_assert(std::has_single_bit(static_cast<unsigned>(kSize)));

std::int32_t block_of(std::int32_t texel) {
  return texel >> std::countr_zero(static_cast<unsigned>(kSize));
}

}  // namespace

GroundAtlas::Reader GroundAtlas::reader() const {
  Reader reader;
  reader.texels_ = texels_.data();
  reader.row_shift_ = std::countr_zero(stride_);
  reader.row_mask_ = row_mask_;
  reader.column_mask_ = column_mask_;
  return reader;
}

void GroundAtlas::prepare(const Window& window, const Casters& casters, int threads) {
  const std::int32_t first_x = block_of(window.first_x);
  const std::int32_t first_y = block_of(window.first_y);
  const std::int32_t last_x = block_of(window.last_x);
  const std::int32_t last_y = block_of(window.last_y);
  const auto side = [](std::int32_t first, std::int32_t last, int present) {
    const auto needed = static_cast<unsigned>(std::clamp(last - first + 1, 1, kMaxBlocks));
    return std::max(static_cast<int>(std::bit_ceil(needed)), present);
  };
  const int blocks_x = side(first_x, last_x, blocks_x_);
  const int blocks_y = side(first_y, last_y, blocks_y_);
  if (blocks_x != blocks_x_ || blocks_y != blocks_y_) {
    blocks_x_ = blocks_x;
    blocks_y_ = blocks_y;
    row_mask_ = blocks_x * kSize - 1;
    column_mask_ = blocks_y * kSize - 1;
    stride_ = static_cast<std::size_t>(blocks_y) * kSize;
    texels_.assign(stride_ * static_cast<std::size_t>(blocks_x) * kSize, GroundTexel{});
    slots_.assign(static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y), Slot{});
  }

  struct Job {
    std::int32_t block_x;
    std::int32_t block_y;
    std::vector<ShadowTriangle> casters;
  };
  std::vector<Job> jobs;
  for (std::int32_t x = first_x; x <= last_x; ++x) {
    for (std::int32_t y = first_y; y <= last_y; ++y) {
      Slot& slot =
          slots_[static_cast<std::size_t>(x & (blocks_x_ - 1)) * blocks_y_ + (y & (blocks_y_ - 1))];
      if (slot.filled && slot.block_x == x && slot.block_y == y) continue;
      slot = {true, x, y};
      jobs.push_back({x, y, {}});
      casters(x, y, jobs.back().casters);
    }
  }
  parallel_bands(static_cast<int>(jobs.size()), threads, [&](int first, int end) {
    GroundBlock block;
    for (int i = first; i < end; ++i) {
      const Job& job = jobs[static_cast<std::size_t>(i)];
      ground_.make_block(job.block_x, job.block_y, job.casters, block);
      const std::int32_t column = job.block_y * kSize & column_mask_;
      for (int row = 0; row < kSize; ++row) {
        const std::int32_t x = (job.block_x * kSize + row) & row_mask_;
        std::copy_n(block.texels.begin() + static_cast<std::ptrdiff_t>(row) * kSize, kSize,
                    texels_.begin() + static_cast<std::ptrdiff_t>(x * stride_) + column);
      }
    }
  });
}

}  // namespace furrow::simulation
