#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "chunk_builder.hpp"

namespace furrow::mcap {

/// Compresses chunks on threads of its own, at most two chunks a thread at a time, and gives them
/// back in the order in which they came.
class ChunkPipeline {
 public:
  ChunkPipeline(std::size_t threads, Compression compression, int zstd_level);
  ~ChunkPipeline();
  ChunkPipeline(const ChunkPipeline&) = delete;
  ChunkPipeline& operator=(const ChunkPipeline&) = delete;

  struct Done {
    ChunkContent content;
    Bytes packed;
    std::uint32_t packed_crc = 0;
    std::uint32_t unpacked_crc = 0;
    std::optional<Error> failure;
  };

  /// True when take() must be called before the next add().
  [[nodiscard]] bool full() const { return waiting_.size() >= capacity_; }
  [[nodiscard]] bool empty() const { return waiting_.empty(); }
  /// @pre not full().
  void add(ChunkContent content);
  /// Waits for the oldest chunk. @pre not empty().
  [[nodiscard]] Done take();
  /// Of the chunks that were not taken yet.
  [[nodiscard]] const std::deque<MessageTally>& tallies() const { return tallies_; }

 private:
  struct Job {
    Done chunk;
    std::promise<Done> done;
  };
  void work(Compression compression, int zstd_level);

  std::size_t capacity_;
  std::deque<std::future<Done>> waiting_;  ///< of the caller
  std::deque<MessageTally> tallies_;       ///< of the same chunks
  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Job> jobs_;
  bool ending_ = false;
  std::vector<std::thread> threads_;  ///< last, because they use all other members
};

}  // namespace furrow::mcap
