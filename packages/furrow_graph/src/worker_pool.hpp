#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace furrow::graph {

/// A fixed pool of threads. parallel_for() calls `work(i)` for every i below `count`, on the calling
/// thread and the workers, and returns when all calls have returned. Call from one thread only.
class WorkerPool {
 public:
  explicit WorkerPool(int threads) {
    for (int i = 1; i < threads; ++i) helpers_.emplace_back([this] { help(); });
  }
  ~WorkerPool() {
    {
      const std::lock_guard lock(mutex_);
      quit_ = true;
    }
    wake_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }

  void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work) {
    if (count <= 1 || helpers_.empty()) {
      for (std::size_t i = 0; i < count; ++i) work(i);
      return;
    }
    {
      const std::lock_guard lock(mutex_);
      work_ = &work;
      next_ = 0;
      count_ = count;
      left_ = count;
    }
    wake_.notify_all();
    std::unique_lock lock(mutex_);
    take(lock);
    done_.wait(lock, [this] { return left_ == 0; });
    work_ = nullptr;
  }

 private:
  void take(std::unique_lock<std::mutex>& lock) {
    while (work_ != nullptr && next_ < count_) {
      const std::size_t mine = next_++;
      const auto* work = work_;
      lock.unlock();
      (*work)(mine);
      lock.lock();
      if (--left_ == 0) done_.notify_one();
    }
  }

  void help() {
    std::unique_lock lock(mutex_);
    while (!quit_) {
      take(lock);
      if (quit_) break;
      wake_.wait(lock, [this] { return quit_ || (work_ != nullptr && next_ < count_); });
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  const std::function<void(std::size_t)>* work_ = nullptr;
  std::size_t next_ = 0;
  std::size_t count_ = 0;
  std::size_t left_ = 0;
  bool quit_ = false;
  std::vector<std::thread> helpers_;
};

}  // namespace furrow::graph
