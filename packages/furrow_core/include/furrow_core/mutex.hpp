#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "furrow_core/thread_annotations.hpp"

namespace furrow {

/// A std::mutex whose use clang's -Wthread-safety checks. Lock it with MutexLock.
class FURROW_CAPABILITY("mutex") Mutex {
 public:
  void lock() FURROW_ACQUIRE() { mutex_.lock(); }
  void unlock() FURROW_RELEASE() { mutex_.unlock(); }

 private:
  friend class ConditionVariable;
  std::mutex mutex_;
};

/// Holds a mutex until the end of the scope, except between unlock() and lock().
class FURROW_SCOPED_CAPABILITY MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) FURROW_ACQUIRE(mutex) : mutex_(mutex) { mutex_.lock(); }
  ~MutexLock() FURROW_RELEASE() {
    if (held_) mutex_.unlock();
  }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  /// @pre The mutex is held.
  void unlock() FURROW_RELEASE() {
    held_ = false;
    mutex_.unlock();
  }
  /// @pre The mutex is not held.
  void lock() FURROW_ACQUIRE() {
    mutex_.lock();
    held_ = true;
  }

 private:
  Mutex& mutex_;
  bool held_ = true;
};

/// A std::condition_variable for Mutex. A wait may also end without a notification: call it in a
/// loop that checks the condition.
class ConditionVariable {
 public:
  void wait(Mutex& mutex) FURROW_REQUIRES(mutex) {
    std::unique_lock lock(mutex.mutex_, std::adopt_lock);
    condition_.wait(lock);
    lock.release();
  }
  /// False when `deadline` has passed.
  bool wait_until(Mutex& mutex, std::chrono::steady_clock::time_point deadline)
      FURROW_REQUIRES(mutex) {
    std::unique_lock lock(mutex.mutex_, std::adopt_lock);
    const bool in_time = condition_.wait_until(lock, deadline) == std::cv_status::no_timeout;
    lock.release();
    return in_time;
  }
  void notify_one() { condition_.notify_one(); }
  void notify_all() { condition_.notify_all(); }

 private:
  std::condition_variable condition_;
};

}  // namespace furrow
