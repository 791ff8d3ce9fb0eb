#pragma once

#include <pthread.h>

#include <system_error>

namespace furrow::log {

/// A mutex with priority inheritance. Its holder runs at the priority of the thread that waits.
/// So a real-time thread waits no longer than the few instructions under the lock.
class PriorityMutex {
 public:
  /// Throws std::system_error.
  PriorityMutex() {
    pthread_mutexattr_t attributes;
    check(pthread_mutexattr_init(&attributes));
    int error = pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT);
    if (error == 0) error = pthread_mutex_init(&mutex_, &attributes);
    pthread_mutexattr_destroy(&attributes);
    check(error);
  }
  ~PriorityMutex() { pthread_mutex_destroy(&mutex_); }
  PriorityMutex(const PriorityMutex&) = delete;
  PriorityMutex& operator=(const PriorityMutex&) = delete;

  void lock() { check(pthread_mutex_lock(&mutex_)); }
  void unlock() { pthread_mutex_unlock(&mutex_); }

 private:
  static void check(int error) {
    if (error != 0) throw std::system_error(error, std::generic_category(), "mutex of the log");
  }
  pthread_mutex_t mutex_;
};

}  // namespace furrow::log
