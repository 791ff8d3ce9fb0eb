#include "chunk_pipeline.hpp"

#include <utility>

namespace furrow::mcap {

ChunkPipeline::ChunkPipeline(std::size_t threads, Compression compression, int zstd_level)
    : capacity_(2 * threads) {
  for (std::size_t i = 0; i < threads; ++i) {
    threads_.emplace_back([this, compression, zstd_level] { work(compression, zstd_level); });
  }
}

ChunkPipeline::~ChunkPipeline() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

void ChunkPipeline::add(ChunkContent content) {
  Job job;
  tallies_.push_back(content.tally);
  job.chunk.content = std::move(content);
  waiting_.push_back(job.done.get_future());
  {
    const std::lock_guard lock(mutex_);
    jobs_.push_back(std::move(job));
  }
  wake_.notify_one();
}

ChunkPipeline::Done ChunkPipeline::take() {
  Done done = waiting_.front().get();
  waiting_.pop_front();
  tallies_.pop_front();
  return done;
}

void ChunkPipeline::work(Compression compression, int zstd_level) {
  Packer packer(compression, zstd_level);
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
    if (jobs_.empty()) {
      return;
    }
    Job job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    Done& chunk = job.chunk;
    if (const auto packed = pack_chunk(packer, compression, chunk.content)) {
      chunk.packed.assign(packed->records.begin(), packed->records.end());
      chunk.packed_crc = packed->packed_crc;
      chunk.unpacked_crc = packed->unpacked_crc;
    } else {
      chunk.failure = packed.error();
    }
    job.done.set_value(std::move(chunk));
    lock.lock();
  }
}

}  // namespace furrow::mcap
