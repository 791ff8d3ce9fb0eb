#pragma once

#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

#include "furrow_core/mutex.hpp"

namespace furrow::graph {

/// A fixed number of threads for parallel_for(). Call it from one thread only.
class WorkerPool {
 public:
  /// `threads` includes the thread that calls parallel_for(). Throws std::system_error.
  explicit WorkerPool(int threads) {
    try {
      for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { serve(); });
    } catch (...) {
      stop();
      throw;
    }
  }
  ~WorkerPool() { stop(); }

  /// Calls `work(i)` for every i below `count` and returns after the last call.
  void parallel_for(std::size_t count, const std::function<void(std::size_t)>& work) {
    if (count <= 1 || workers_.empty()) {
      for (std::size_t i = 0; i < count; ++i) work(i);
      return;
    }
    {
      const MutexLock lock(mutex_);
      work_ = &work;
      next_ = 0;
      count_ = count;
      left_ = count;
    }
    wake_.notify_all();
    take();
    const MutexLock lock(mutex_);
    while (left_ > 0) done_.wait(mutex_);
    work_ = nullptr;
  }

 private:
  [[nodiscard]] bool has_work() const FURROW_REQUIRES(mutex_) {
    return work_ != nullptr && next_ < count_;
  }

  void take() {
    MutexLock lock(mutex_);
    while (has_work()) {
      const std::size_t index = next_++;
      const auto* work = work_;
      lock.unlock();
      (*work)(index);
      lock.lock();
      if (--left_ == 0) done_.notify_one();
    }
  }

  void serve() {
    while (true) {
      take();
      const MutexLock lock(mutex_);
      while (!quit_ && !has_work()) wake_.wait(mutex_);
      if (quit_) return;
    }
  }

  void stop() {
    {
      const MutexLock lock(mutex_);
      quit_ = true;
    }
    wake_.notify_all();
    for (std::thread& worker : workers_) worker.join();
  }

  Mutex mutex_;
  ConditionVariable wake_;
  ConditionVariable done_;
  const std::function<void(std::size_t)>* work_ FURROW_GUARDED_BY(mutex_) = nullptr;
  std::size_t next_ FURROW_GUARDED_BY(mutex_) = 0;
  std::size_t count_ FURROW_GUARDED_BY(mutex_) = 0;
  std::size_t left_ FURROW_GUARDED_BY(mutex_) = 0;
  bool quit_ FURROW_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> workers_;
};

}  // namespace furrow::graph
